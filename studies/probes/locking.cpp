// Probe locking: displacement and pressure of nearly incompressible bodies against fem Q2.

#include "scene/output.hpp"
#include "studies/probes/roughness.hpp"
#include "studies/probes/states.hpp"
#include "studies/probes/whole_run.hpp"

#include <fmt/format.h>

#include <unistd.h>

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
           number_option("reference", "1", "32", 1, 1000, ">= 1",
                         "resolution of the fem Q2 solution")},
          {{"tip_ratio", "1", "the displacement over that of fem Q2"},
           {"tip_error", "1", "|tip_ratio - 1|"},
           {"pressure_roughness", "1",
            "pressure less its linear fit over the neighbours of a point, over that fit (root "
            "mean squares without the largest 5 %: singular corners)"}}};
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
  const double tip = done.result.quantities.at(name);
  return {tip, std::move(done.result)};
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The displacement by fem Q2. Every method of a scene is held against the same solution: it is
/// kept beside the full text of what was solved.
double reference_tip(const ProbeRequest& request) {
  const std::string content =
      fmt::format("{}\n{}\n{} at {:.17g}\n", request.problem.normalised_text,
                  text_of(request.problem.geometry), request.options.word("quantity"),
                  request.options.number("reference"));
  const std::filesystem::path file =
      request.keep / fmt::format("{:016x}.txt", std::hash<std::string>{}(content));
  if (!request.keep.empty()) {
    const std::string kept = text_of(file);
    const std::size_t line = kept.find('\n');
    if (line != std::string::npos && kept.substr(line + 1) == content) return std::stod(kept);
  }
  ProbeRequest other{request.problem, scene::MethodRegistry::instance().find("fem"),
                     request.run, request.options};
  other.run.h = request.problem.reference_length / request.options.number("reference");
  other.run.perturb = 0;
  other.run.settings = {{"element", "Q2"}};
  const double tip = solve(other).tip;
  if (!request.keep.empty()) {
    // A name of its own: several probes may solve the same at once.
    const std::filesystem::path own = fmt::format("{}.{}", file.string(), getpid());
    scene::write_file(own, fmt::format("{:.17g}\n{}", tip, content));
    std::filesystem::rename(own, file);
  }
  return tip;
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
    const double reference = reference_tip(request);
    result.particles = own.run.particles;
    result.unknowns = own.run.unknowns;
    result.steps = own.run.steps;
    auto& q = result.quantities;
    q["tip_ratio"] = own.tip / reference;
    q["tip_error"] = std::abs(own.tip / reference - 1);

    const std::unique_ptr<scene::DiscreteBody> body = request.body();
    std::vector<double> pressure(body->positions().size());
    body->pressure(displacement(*body, own.run), pressure);
    const Parts parts = split_roughness(body->dim(), body->positions(), pressure);
    q["pressure_roughness"] = trimmed_rms(parts.rough) / trimmed_rms(parts.smooth);
    write(request, *body, pressure);
  }

 private:
  static void write(const ProbeRequest& request, const scene::DiscreteBody& body,
                    const std::vector<double>& pressure) {
    if (request.run.out.empty()) return;
    std::ofstream csv(request.run.out / "pressure.csv");
    csv << "X_m,Y_m,Z_m,pressure_Pa\n";
    for (std::size_t a = 0; a < pressure.size(); ++a) {
      const Vec3& X = body.positions()[a];
      csv << fmt::format("{:.8g},{:.8g},{:.8g},{:.8g}\n", X[0], X[1], X[2], pressure[a]);
    }
  }

  ProbeInfo m_info = locking_info();
};

const RegisterProbe<Locking> registered;

}  // namespace
}  // namespace concord::probes
