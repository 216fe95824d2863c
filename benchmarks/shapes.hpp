/// \file
/// The generated shapes of ahm::conformance that the benchmarks run on.
#pragma once

#include <vector>

#include "ahm/conformance/clouds.hpp"
#include "ahm/conformance/triangle_meshes.hpp"
#include "ahm/conformance/vectors.hpp"

namespace ahm::bench {

using test::dot;
using test::Mesh;
using test::split_icosphere;
using test::torus;
using test::unit;

}  // namespace ahm::bench
