// Probe rotation: a spinning free body over many turns: momenta, energy, shape.

#include "studies/probes/whole_run.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace concord::probes {
namespace {

ProbeInfo rotation_info() {
  return {"rotation",
          "A spinning free body over many turns",
          "rotations leave energy and both momenta: delaunay_particle_method, section 3",
          {number_option("turns", "1", "100", 0.01, 1e9, "> 0",
                         "of the body as its initial velocity spins it")},
          {{"turns_done", "1", "turns before the run ended"},
           {"finished", "1",
            "turns_done over the option `turns`; below 1 the numbers that follow are absent"},
           {"angular_momentum_drift", "1", "over sum m|x||v|"},
           {"linear_momentum_drift", "1", "over sum m|v|"},
           {"drift", "1", "of the energy, over the largest energy"},
           {"trend", "1", "energy of the last tenth less that of the first, over the latter"},
           {"shape_change", "1",
            "root mean square distance from the best rigid motion at the end, over the body's "
            "root mean square radius"},
           {"nonaffine", "1", "the same from the best affine motion: noise, bending"}}};
}

/// |I^-1 L| of the initial velocity about the centre of mass [rad/s].
double angular_speed(const scene::DiscreteBody& body, const scene::Problem& problem) {
  if (!problem.initial_velocity || body.dim() != 3) {
    throw InputError({problem.file.string()}, "SCENE", "a body that does not spin at t = 0",
                     "a free body in space with an initial velocity");
  }
  double mass = 0;
  Vec3 centre = Vec3::Zero(), linear = Vec3::Zero(), angular = Vec3::Zero();
  const auto n = body.positions().size();
  for (std::size_t a = 0; a < n; ++a) {
    mass += body.masses()[a];
    centre += body.masses()[a] * body.positions()[a];
    linear += body.masses()[a] * (*problem.initial_velocity)(body.positions()[a], 0);
  }
  centre /= mass;
  Mat3 inertia = Mat3::Zero();
  for (std::size_t a = 0; a < n; ++a) {
    const Vec3 r = body.positions()[a] - centre;
    const Vec3 v = (*problem.initial_velocity)(body.positions()[a], 0) - linear / mass;
    angular += body.masses()[a] * r.cross(v);
    inertia += body.masses()[a] * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  const double speed = inertia.ldlt().solve(angular).norm();
  if (!(speed > 0)) {
    throw InputError({problem.file.string()}, "initial.velocity", "no spin", "a spin");
  }
  return speed;
}

/// Distances from the best rigid and the best affine motion of weighted points, over their root
/// mean square radius. The rigid one by W. Kabsch, Acta Cryst. A 32 (1976) 922-923.
void tell_shape(const scene::Samples& samples, std::map<std::string, double>& q) {
  double weight = 0;
  Vec3 X0 = Vec3::Zero(), x0 = Vec3::Zero();
  for (std::size_t k = 0; k < samples.X.size(); ++k) {
    weight += samples.weight[k];
    X0 += samples.weight[k] * samples.X[k];
    x0 += samples.weight[k] * (samples.X[k] + samples.u[k]);
  }
  X0 /= weight, x0 /= weight;
  Mat3 A = Mat3::Zero(), M = Mat3::Zero();
  for (std::size_t k = 0; k < samples.X.size(); ++k) {
    const Vec3 R = samples.X[k] - X0, r = samples.X[k] + samples.u[k] - x0;
    A += samples.weight[k] * r * R.transpose();
    M += samples.weight[k] * R * R.transpose();
  }
  const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 flip = Mat3::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Mat3 rotation = svd.matrixU() * flip * svd.matrixV().transpose();
  const Mat3 affine = A * M.inverse();
  double rigid2 = 0, affine2 = 0;
  for (std::size_t k = 0; k < samples.X.size(); ++k) {
    const Vec3 R = samples.X[k] - X0, r = samples.X[k] + samples.u[k] - x0;
    rigid2 += samples.weight[k] * (r - rotation * R).squaredNorm();
    affine2 += samples.weight[k] * (r - affine * R).squaredNorm();
  }
  q["shape_change"] = std::sqrt(rigid2 / M.trace());
  q["nonaffine"] = std::sqrt(affine2 / M.trace());
}

class Rotation final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    scene::Problem problem = request.problem;
    const double turns = request.options.number("turns");
    const double turn = 2 * M_PI / angular_speed(*request.body(), problem);
    problem.end_time = turns * turn;
    problem.frames = 0;
    const std::filesystem::path folder =
        request.run.out.empty() ? std::filesystem::path() : request.run.out / "run";
    const Attempt end = attempt(request, problem, folder);
    tell_run(end, result);
    auto& q = result.quantities;
    q["turns_done"] = end.result.t_end / turn;
    q["finished"] = end.failed ? end.result.t_end / problem.end_time : 1.0;
    if (end.failed) {  // drifts of a run cut short say nothing about all its turns
      result.notes["not_measured"] = "the run ended before its last turn: " + end.error;
      return;
    }
    tell_momenta(end, q);
    if (!folder.empty()) tell_energy(folder, q);
    tell_shape(end.result.samples, q);
  }

 private:
  ProbeInfo m_info = rotation_info();
};

const RegisterProbe<Rotation> registered;

}  // namespace
}  // namespace concord::probes
