#pragma once
// Bodies made of springs, whose frequencies are known, and methods that show them.

#include "scene/reader.hpp"
#include "studies/probes/probe.hpp"

#include <functional>

namespace concord::probes::test {

/// Points on a line in the plane, masses m, force f = -K u with any matrix K over the x
/// components; y components are prescribed.
class Springs : public scene::DiscreteBody {
 public:
  Springs(Eigen::MatrixXd K, double mass, double estimate)
      : m_K(std::move(K)), m_masses(m_K.rows(), mass), m_estimate(estimate) {
    for (Eigen::Index a = 0; a < m_K.rows(); ++a)
      m_positions.emplace_back(0.1 * static_cast<double>(a), 0, 0);
  }
  int dim() const override { return 2; }
  std::span<const Vec3> positions() const override { return m_positions; }
  std::span<const double> masses() const override { return m_masses; }
  unsigned prescribed(Index) const override { return 2; }
  void force(std::span<const double> u, std::span<double> f) override {
    for (Eigen::Index a = 0; a < m_K.rows(); ++a) {
      f[2 * a] = f[2 * a + 1] = 0;
      for (Eigen::Index b = 0; b < m_K.rows(); ++b) f[2 * a] -= m_K(a, b) * u[2 * b];
    }
  }
  double energy(std::span<const double>) override { return 0; }
  void pressure(std::span<const double>, std::span<double> p) override {
    for (double& value : p) value = 0;
  }
  Eigen::SparseMatrix<double> stiffness(std::span<const double>) override {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * m_K.rows(), 2 * m_K.rows());
    for (Eigen::Index a = 0; a < m_K.rows(); ++a)
      for (Eigen::Index b = 0; b < m_K.rows(); ++b) all(2 * a, 2 * b) = m_K(a, b);
    return all.sparseView();
  }
  double critical_step(std::span<const double>) override { return m_estimate; }

 private:
  Eigen::MatrixXd m_K;
  std::vector<double> m_masses;
  double m_estimate;
  std::vector<Vec3> m_positions;
};

/// n equal masses joined by springs k: free at both ends. Eigenvalues 4 k/m sin^2(j pi/(2 n)),
/// j = 0 .. n-1.
inline Eigen::MatrixXd chain(int n, double k) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (int a = 0; a + 1 < n; ++a) {
    K(a, a) += k, K(a + 1, a + 1) += k;
    K(a, a + 1) -= k, K(a + 1, a) -= k;
  }
  return K;
}

/// A method that shows what a function makes, and runs another one.
class MadeUp : public scene::Method, public scene::Discretises {
 public:
  using Maker = std::function<std::unique_ptr<scene::DiscreteBody>(const scene::RunRequest&)>;
  using Runner = std::function<void(const scene::RunRequest&, scene::Result&)>;
  explicit MadeUp(Maker make, Runner run = {})
      : m_make(std::move(make)), m_run(std::move(run)) {}
  const scene::MethodInfo& info() const override { return m_info; }
  void run(const scene::Problem&, const scene::RunRequest& request,
           scene::Result& result) const override {
    m_run(request, result);
  }
  std::unique_ptr<scene::DiscreteBody>
  discretise(const scene::Problem&, const scene::RunRequest& request) const override {
    return m_make(request);
  }

 private:
  scene::MethodInfo m_info{"made_up", "", ""};
  Maker m_make;
  Runner m_run;
};

/// Runs a probe of the registry with options on a problem.
inline scene::Result run_probe(const std::string& name, const scene::Problem& problem,
                               const scene::Method& method, const scene::RunRequest& run,
                               const std::map<std::string, std::string>& options) {
  const Probe& probe = ProbeRegistry::instance().find(name);
  scene::Result result;
  probe.run({problem, method, run, {name, probe.info().options, options}}, result);
  return result;
}

}  // namespace concord::probes::test
