// Probe locking: displacement and pressure of nearly incompressible bodies against fem Q2.

#include "studies/probes/roughness.hpp"
#include "studies/probes/states.hpp"
#include "studies/probes/whole_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace concord::probes {
namespace {

ProbeInfo locking_info() {
  return {"locking",
          "Displacement and pressure of a static scene against fem Q2",
          "Cook's membrane as a test of nearly incompressible bodies: T. J. R. Hughes, The "
          "Finite Element Method (1987), chapter 4",
          {{"quantity", "1", "tip_y", "a quantity of the scene", "the displacement looked at"},
           number_option("reference", "1", "16", 1, 1000, ">= 1",
                         "resolution of the fem Q2 solution")},
          {{"tip_ratio", "1", "the displacement over that of fem Q2"},
           {"tip_error", "1", "|tip_ratio - 1|"},
           {"pressure_roughness", "1",
            "pressure less its linear fit over neighbours, root mean square, over that of the "
            "reference pressure (both without the largest 5 %)"},
           {"reference_roughness", "1", "the same of the reference at the same points"},
           {"pressure_error", "1",
            "difference of the pressures at the points, relative root mean square (without the "
            "largest 5 %)"}}};
}

/// Nodal displacements of a finished run at the points of its body.
std::vector<double> displacement(const scene::DiscreteBody& body, const scene::Result& run) {
  const std::vector<Vec3> X(body.positions().begin(), body.positions().end());
  std::vector<Vec3> u(X.size());
  if (run.samples.X == X)
    u = run.samples.u;
  else
    run.field->evaluate(X, u, {});
  const auto dim = static_cast<std::size_t>(body.dim());
  std::vector<double> flat(X.size() * dim);
  for (std::size_t k = 0; k < flat.size(); ++k)
    flat[k] = u[k / dim][static_cast<Eigen::Index>(k % dim)];
  return flat;
}

struct Solution {
  std::vector<Vec3> X;
  std::vector<double> pressure;
  double tip = 0;
  scene::Result run;
};

Solution solve(const ProbeRequest& request) {
  Attempt done = attempt(request, request.problem, {});
  if (done.failed)
    throw SolveError(done.quantity, done.result.steps, done.result.t_end, -1, done.error);
  const std::string& name = request.options.word("quantity");
  if (!done.result.quantities.contains(name)) {
    std::string known;
    for (const auto& [quantity, value] : done.result.quantities) known += " " + quantity;
    throw InputError({"command line"}, "locking.quantity", '"' + name + '"',
                     "a quantity of the scene:" + known);
  }
  Solution s;
  const std::unique_ptr<scene::DiscreteBody> body = request.body();
  s.X.assign(body->positions().begin(), body->positions().end());
  s.pressure.resize(s.X.size());
  body->pressure(displacement(*body, done.result), s.pressure);
  s.tip = done.result.quantities.at(name);
  s.run = std::move(done.result);
  return s;
}

/// The reference's pressure at its node nearest to each point.
std::vector<double> at_points(const Solution& reference, const std::vector<Vec3>& X) {
  std::vector<double> pressure;
  for (const Vec3& point : X) {
    std::size_t nearest = 0;
    for (std::size_t a = 1; a < reference.X.size(); ++a) {
      if ((reference.X[a] - point).squaredNorm() < (reference.X[nearest] - point).squaredNorm())
        nearest = a;
    }
    pressure.push_back(reference.pressure[nearest]);
  }
  return pressure;
}

class Locking final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    if (!request.problem.is_static) {
      throw InputError({request.problem.file.string()}, "SCENE", "a dynamic scene",
                       "a static one");
    }
    const Solution own = solve(request);
    ProbeRequest other{request.problem, scene::MethodRegistry::instance().find("fem"),
                       request.run, request.options};
    other.run.h = request.problem.reference_length / request.options.number("reference");
    other.run.perturb = 0;
    other.run.settings = {{"element", "Q2"}};
    const Solution fem = solve(other);
    result.particles = own.run.particles;
    result.unknowns = own.run.unknowns;
    result.steps = own.run.steps;
    const std::vector<double> reference = at_points(fem, own.X);
    std::vector<double> difference;
    for (std::size_t a = 0; a < reference.size(); ++a)
      difference.push_back(own.pressure[a] - reference[a]);
    const double scale = trimmed_rms(reference);
    const int dim = request.problem.dim();
    auto& q = result.quantities;
    q["tip_ratio"] = own.tip / fem.tip;
    q["tip_error"] = std::abs(own.tip / fem.tip - 1);
    q["pressure_roughness"] = trimmed_rms(roughness(dim, own.X, own.pressure)) / scale;
    q["reference_roughness"] = trimmed_rms(roughness(dim, own.X, reference)) / scale;
    q["pressure_error"] = trimmed_rms(difference) / scale;
    write(request, own, reference);
  }

 private:
  static void write(const ProbeRequest& request, const Solution& own,
                    const std::vector<double>& reference) {
    if (request.run.out.empty()) return;
    std::ofstream csv(request.run.out / "pressure.csv");
    csv << "X_m,Y_m,Z_m,pressure_Pa,reference_Pa\n";
    for (std::size_t a = 0; a < own.X.size(); ++a)
      csv << fmt::format("{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", own.X[a][0], own.X[a][1],
                         own.X[a][2], own.pressure[a], reference[a]);
  }

  ProbeInfo m_info = locking_info();
};

const RegisterProbe<Locking> registered;

}  // namespace
}  // namespace concord::probes
