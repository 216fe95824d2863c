// Products of tall matrices by Eigen, for builds without a BLAS.
#include "cholesky/tall_products.hpp"

#include <Eigen/Core>

namespace ahm {
namespace {

using Strided = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

Strided view(const TallChunk& A, Offset columns) {
  return {A.values, static_cast<Eigen::Index>(A.rows), static_cast<Eigen::Index>(columns),
          Eigen::OuterStride<>(A.stride)};
}

}  // namespace

void transposed_product(const TallChunk& A, Offset a, const TallChunk& B, Offset b, double* C) {
  Eigen::Map<Eigen::MatrixXd>(C, a, b).noalias() = view(A, a).transpose() * view(B, b);
}

void add_tall_product(const TallChunk& A, Offset a, const double* C, Offset stride_C, double factor, double* B,
                      Offset stride_B, Offset b) {
  Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(B, A.rows, b, Eigen::OuterStride<>(stride_B)).noalias() +=
      factor * view(A, a) * view({C, stride_C, a}, b);
}

}  // namespace ahm
