// Probe checkerboard: whether alternating displacements are driven back.

#include "studies/probes/states.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace concord::probes {
namespace {

ProbeInfo checkerboard_info() {
  ProbeInfo info{
      "checkerboard",
      "Restoring force on alternating displacements",
      "zero-energy modes of nearest-neighbour gradients: k in {0, pi/h}^dim, "
      "particle/delaunay/README.md",
      {number_option("amplitude", "1", "1e-6", 1e-9, 1e-2, "1e-9 .. 1e-2",
                     "of the displacements, in spacings")},
      {{"restoring", "1",
        "least Rayleigh quotient over all alternating displacements, over that of a shear wave "
        "as short, c_s^2 (pi/h)^2: below 0 they grow. They fade towards the surface as half a "
        "sine along every axis, so that surface particles do not answer for the others"},
       {"restoring_corner", "1", "the same over displacements that alternate along every axis"},
       {"growth_rate", "c_s pi/h", "sqrt(-restoring) where it is negative, else 0"}}};
  for (const scene::ParameterInfo& option : deformation_options())
    info.options.push_back(option);
  return info;
}

/// Product of sin(pi s_i), s_i from 0 to 1 along every axis: half a sine, 0 on the surface of a
/// block.
std::vector<double> envelope(const scene::DiscreteBody& body) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Vec3& X : body.positions()) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  std::vector<double> values;
  for (const Vec3& X : body.positions()) {
    double value = 1;
    for (int i = 0; i < body.dim(); ++i)
      value *= std::sin(M_PI * (X[i] - low[i]) / (high[i] - low[i]));
    values.push_back(value);
  }
  return values;
}

/// Alternating displacements times the envelope: columns, one a pattern and component.
Eigen::MatrixXd displacements(const scene::DiscreteBody& body,
                              const std::vector<std::vector<double>>& patterns) {
  const auto dim = static_cast<std::size_t>(body.dim());
  const std::size_t n = body.positions().size();
  const std::vector<double> fades = envelope(body);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n * dim),
                                            static_cast<Eigen::Index>(patterns.size() * dim));
  for (std::size_t p = 0; p < patterns.size(); ++p) {
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t i = 0; i < dim; ++i) {
        if ((body.prescribed(static_cast<Index>(a)) >> i & 1U) == 0)
          D(static_cast<Eigen::Index>(a * dim + i), static_cast<Eigen::Index>(p * dim + i)) =
              fades[a] * patterns[p][a];
      }
    }
  }
  return D;
}

/// Least eigenvalue of (D^T K D, D^T M D), K by central differences of the force, symmetrised.
double least_quotient(scene::DiscreteBody& body, std::span<const double> u,
                      const Eigen::MatrixXd& D, double step) {
  Eigen::MatrixXd KD(D.rows(), D.cols()), MD = D;
  for (Eigen::Index row = 0; row < D.rows(); ++row)
    MD.row(row) *= body.masses()[static_cast<std::size_t>(row) / body.dim()];
  std::vector<double> moved(u.size()), f(u.size());
  for (Eigen::Index c = 0; c < D.cols(); ++c) {
    KD.col(c).setZero();
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t k = 0; k < u.size(); ++k)
        moved[k] = u[k] + sign * step * D(static_cast<Eigen::Index>(k), c);
      body.force(moved, f);
      KD.col(c) -=
          sign / (2 * step) *
          Eigen::Map<const Eigen::VectorXd>(f.data(), static_cast<Eigen::Index>(f.size()));
    }
  }
  const Eigen::MatrixXd K = D.transpose() * KD, M = D.transpose() * MD;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (K + K.transpose()), M,
                                                                   Eigen::EigenvaluesOnly)
      .eigenvalues()
      .minCoeff();
}

class Checkerboard final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    const std::unique_ptr<scene::DiscreteBody> body = request.body();
    tell_size(*body, result);
    const double h = point_spacing(*body, request);
    const double wave = request.problem.material.shear_wave_speed() * M_PI / h;
    const double step = request.options.number("amplitude") * h;
    const std::vector<double> u = deformed(*body, request.options);
    std::vector<std::vector<double>> patterns = checkerboards(*body, h);
    auto& q = result.quantities;
    const double least =
        least_quotient(*body, u, displacements(*body, patterns), step) / (wave * wave);
    q["restoring"] = least;
    q["growth_rate"] = std::sqrt(std::max(0.0, -least));
    patterns.erase(patterns.begin(), patterns.end() - 1);
    q["restoring_corner"] =
        least_quotient(*body, u, displacements(*body, patterns), step) / (wave * wave);
  }

 private:
  /// The spacing of the body's points: h, or that of a method with points between (Q2).
  static double point_spacing(const scene::DiscreteBody& body, const ProbeRequest& request) {
    const double d = shortest_distance(body.positions());
    return request.run.perturb == 0 && d < 0.75 * request.run.h ? d : request.run.h;
  }

  ProbeInfo m_info = checkerboard_info();
};

const RegisterProbe<Checkerboard> registered;

}  // namespace
}  // namespace concord::probes
