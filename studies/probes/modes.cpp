#include "studies/probes/modes.hpp"

#include "studies/probes/states.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numeric>

// LAPACK's own interface: there is no C header for it in Debian's LAPACK (lapacke is another
// library).
extern "C" {
void dsyevd_(const char* jobz, const char* uplo, const int* n, double* a, const int* lda,
             double* w, double* work, const int* lwork, int* iwork, const int* liwork,
             int* info);
void dgeev_(const char* jobvl, const char* jobvr, const int* n, double* a, const int* lda,
            double* wr, double* wi, double* vl, const int* ldvl, double* vr, const int* ldvr,
            double* work, const int* lwork, int* info);
}

namespace concord::probes {
namespace {

/// Below this the asymmetry is round-off of the assembly.
constexpr double symmetric_below = 1e-9;

void check(int info) {
  if (info != 0) throw SolveError("eigenvalues", 0, 0, -1, "LAPACK did not converge");
}

Modes symmetric_modes(Eigen::MatrixXd& A) {
  const int n = static_cast<int>(A.rows());
  Modes modes;
  modes.real.resize(n);
  modes.imaginary.assign(n, 0.0);
  std::vector<double> work(2 * static_cast<std::size_t>(n) * 34 + 1);
  const int size = static_cast<int>(work.size()), one = 1;
  int integer = 0, info = 0;
  dsyevd_("N", "L", &n, A.data(), &n, modes.real.data(), work.data(), &size, &integer, &one,
          &info);
  check(info);
  return modes;
}

Modes general_modes(Eigen::MatrixXd& A) {
  const int n = static_cast<int>(A.rows());
  std::vector<double> real(n), imaginary(n), work(static_cast<std::size_t>(n) * 70);
  const int size = static_cast<int>(work.size()), one = 1;
  int info = 0;
  dgeev_("N", "N", &n, A.data(), &n, real.data(), imaginary.data(), nullptr, &one, nullptr,
         &one, work.data(), &size, &info);
  check(info);
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return real[a] < real[b]; });
  Modes modes;
  for (const int k : order) {
    modes.real.push_back(real[k]);
    modes.imaginary.push_back(imaginary[k]);
  }
  return modes;
}

}  // namespace

Modes modes(scene::DiscreteBody& body, std::span<const double> u) {
  const Eigen::SparseMatrix<double> K = body.stiffness(u);
  const std::vector<int> free = free_components(body);
  std::vector<int> number(K.rows(), -1);
  for (std::size_t k = 0; k < free.size(); ++k) number[free[k]] = static_cast<int>(k);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(free.size()),
                                            static_cast<Eigen::Index>(free.size()));
  for (int column = 0; column < K.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(K, column); it; ++it) {
      const int i = number[it.row()], j = number[it.col()];
      if (i < 0 || j < 0) continue;
      const double mass =
          body.masses()[it.row() / body.dim()] * body.masses()[it.col() / body.dim()];
      A(i, j) = it.value() / std::sqrt(mass);
    }
  }
  const double asymmetry = (A - A.transpose()).norm() / A.norm();
  Modes result = asymmetry < symmetric_below ? symmetric_modes(A) : general_modes(A);
  result.asymmetry = asymmetry;
  return result;
}

}  // namespace concord::probes
