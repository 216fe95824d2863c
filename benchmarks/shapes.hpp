/// \file
/// The generated shapes of ahm::testing that the benchmarks run on.
#pragma once

#include <vector>

#include "ahm/testing/clouds.hpp"
#include "ahm/testing/triangle_meshes.hpp"
#include "ahm/testing/vectors.hpp"

namespace ahm::bench {

using test::dot;
using test::Mesh;
using test::split_icosphere;
using test::torus;
using test::unit;

}  // namespace ahm::bench
