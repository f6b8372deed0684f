// Eigen's EigenSolver and its kin for eigenvalues alone: their steps without those of the
// eigenvectors, which take two thirds of the time to compile.

#include "engine/sph/stability/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace sluice {
namespace {

using Eigen::Index;

/// Upper triangular but for the 2 x 2 blocks of conjugate pairs.
WaveMatrix real_schur_form(const WaveMatrix& matrix) {
  const double scale = matrix.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return matrix;
  const Eigen::HessenbergDecomposition<WaveMatrix> hessenberg(matrix / scale);
  Eigen::RealSchur<WaveMatrix> schur(matrix.rows());
  schur.computeFromHessenberg(hessenberg.matrixH(), WaveMatrix(), /*computeU=*/false);
  return schur.matrixT() * scale;
}

/// Calls f(eigenvalue) for each.
template <class F>
void for_each_eigenvalue(const WaveMatrix& matrix, const F& f) {
  const WaveMatrix t = real_schur_form(matrix);
  for (Index i = 0; i < t.rows(); ++i) {
    if (i + 1 == t.rows() || t(i + 1, i) == 0.0) {
      f(std::complex<double>(t(i, i)));
      continue;
    }
    const double half = 0.5 * (t(i, i) - t(i + 1, i + 1));
    const double largest = std::max({std::abs(half), std::abs(t(i + 1, i)), std::abs(t(i, i + 1))});
    const double p = half / largest;
    const double product = t(i + 1, i) / largest * (t(i, i + 1) / largest);
    const double imaginary = largest * std::sqrt(std::abs(p * p + product));
    f(std::complex<double>(t(i + 1, i + 1) + half, imaginary));
    f(std::complex<double>(t(i + 1, i + 1) + half, -imaginary));
    ++i;
  }
}

/// Upper triangular.
Eigen::MatrixXcd complex_schur_form(const Eigen::MatrixXcd& matrix) {
  const Eigen::HessenbergDecomposition<Eigen::MatrixXcd> hessenberg(matrix);
  Eigen::ComplexSchur<Eigen::MatrixXcd> schur(matrix.rows());
  schur.computeFromHessenberg(hessenberg.matrixH(), Eigen::MatrixXcd(), /*computeU=*/false);
  return schur.matrixT();
}

}  // namespace

std::vector<std::complex<double>> eigenvalues(const WaveMatrix& matrix) {
  std::vector<std::complex<double>> all;
  for_each_eigenvalue(matrix, [&](const std::complex<double>& each) { all.push_back(each); });
  return all;
}

std::vector<std::complex<double>> eigenvalues(const Eigen::MatrixXcd& matrix) {
  const Eigen::VectorXcd all = complex_schur_form(matrix).diagonal();
  return {all.begin(), all.end()};
}

double spectral_radius(const WaveMatrix& matrix) {
  double most = 0.0;
  for_each_eigenvalue(
      matrix, [&](const std::complex<double>& each) { most = std::max(most, std::abs(each)); });
  return most;
}

double spectral_radius(const Eigen::MatrixXcd& matrix) {
  return complex_schur_form(matrix).diagonal().cwiseAbs().maxCoeff();
}

double largest_eigenvalue(const WaveMatrix& symmetric) {
  const double scale = symmetric.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return 0.0;
  // The Hessenberg form of a symmetric matrix has three diagonals.
  const Eigen::HessenbergDecomposition<WaveMatrix> hessenberg(symmetric / scale);
  const WaveMatrix tridiagonal = hessenberg.matrixH();
  Eigen::SelfAdjointEigenSolver<WaveMatrix> solver;
  solver.computeFromTridiagonal(tridiagonal.diagonal(), tridiagonal.diagonal<-1>(),
                                Eigen::EigenvaluesOnly);
  return (solver.eigenvalues() * scale).maxCoeff();
}

}  // namespace sluice
