#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace sluice {

/// A matrix of a plane wave: of its velocity alone, or of velocity and density, in at most three
/// dimensions.
using WaveMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;

/// All eigenvalues of a square matrix, each as often as its multiplicity, in no order.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues(const WaveMatrix& matrix);
[[nodiscard]] std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXcd& matrix);

/// The largest modulus of an eigenvalue.
[[nodiscard]] double spectral_radius(const WaveMatrix& matrix);
[[nodiscard]] double spectral_radius(const Eigen::MatrixXcd& matrix);

/// The largest eigenvalue of a symmetric matrix, none of whose eigenvalues is negative.
[[nodiscard]] double largest_eigenvalue(const WaveMatrix& symmetric);

}  // namespace sluice
