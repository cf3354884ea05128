// Method `calculix`: a scene run by the program ccx.

#include "fem_reference/calculix/deck.hpp"
#include "fem_reference/calculix/options.hpp"
#include "fem_reference/calculix/process.hpp"
#include "fem_reference/calculix/report.hpp"
#include "fem_reference/calculix/result_files.hpp"
#include "scene/interrupt.hpp"
#include "scene/output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <system_error>

namespace concord::calculix {
namespace {

namespace fs = std::filesystem;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Folder that CalculiX works in: `calculix` in the run's own one, of which the deck and the
/// messages stay, or a temporary one, of which nothing does.
class Workplace {
 public:
  Workplace(const fs::path& out, bool keep) : m_temporary(out.empty()), m_keep(keep) {
    if (m_temporary) {
      std::string name = (fs::temp_directory_path() / "concord-calculix-XXXXXX").string();
      if (mkdtemp(name.data()) == nullptr)
        throw std::system_error(errno, std::generic_category(), name);
      m_folder = name;
    } else {
      m_folder = fs::absolute(out) / "calculix";
      fs::remove_all(m_folder);
      fs::create_directories(m_folder);
    }
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  ~Workplace() {
    std::error_code ignored;
    if (m_temporary) {
      fs::remove_all(m_folder, ignored);
      return;
    }
    if (m_keep) return;
    for (const auto& entry : fs::directory_iterator(m_folder, ignored)) {
      const fs::path name = entry.path().filename();
      if (name != "job.inp" && name != "job.log") fs::remove(entry.path(), ignored);
    }
  }
  fs::path operator/(const char* name) const { return m_folder / name; }
  const fs::path& folder() const { return m_folder; }

 private:
  fs::path m_folder;
  bool m_temporary, m_keep;
};

scene::Mesh make_problem_mesh(const scene::Problem& problem, const scene::RunRequest& request) {
  scene::MeshRequest wanted;
  wanted.h = request.h;
  wanted.shape = scene::CellShape::simplex;
  wanted.order = 2;
  wanted.layout = problem.layout;
  return scene::make_mesh(problem, wanted);
}

void describe(const scene::Problem& problem, const Options& options,
              const HardeningTable& hardening, scene::Result& result) {
  result.notes["element"] = "P2";
  result.notes["solver"] = "CalculiX";
  result.notes["quadrature"] = problem.dim() == 2 ? "3 points" : "4 points";
  if (!problem.material.plastic()) return;
  result.notes["yield measure"] = "Cauchy";
  result.notes["hardening table"] =
      fmt::format("{} points, relative error {:.1e} up to a plastic strain of {:g}, straight "
                  "beyond",
                  options.hardening_points, hardening.error, sampled_strain);
}

Progress progress_of(const Workplace& place) {
  std::ifstream file(place / "job.sta");
  return read_sta(file);
}

class Calculix : public scene::Method {
 public:
  const scene::MethodInfo& info() const override { return method_info(); }

  void run(const scene::Problem& problem, const scene::RunRequest& request,
           scene::Result& result) const override {
    const double started = now();
    const Options options = read_options(problem, request);
    const scene::Mesh mesh = make_problem_mesh(problem, request);
    const Quantities quantities(problem, mesh);
    const fs::path program = find_program();
    if (program.empty())
      throw SolveError("the start of CalculiX", 0, 0, -1,
                       "there is no program ccx on PATH; install the package calculix-ccx");
    const Motion motion = prescribed_motion(problem, mesh, options.steps);
    const HardeningTable hardening =
        problem.material.plastic()
            ? hardening_table(problem.material.hardening, options.hardening_points)
            : HardeningTable();
    result.h = request.h;
    result.particles = static_cast<long>(mesh.nodes.size());
    result.unknowns = result.particles * mesh.dim - static_cast<long>(motion.entries.size());
    result.threads = request.threads;
    describe(problem, options, hardening, result);

    const Workplace place(request.out, options.keep_files);
    scene::write_file(place / "job.inp", deck_text(problem, mesh, options, motion,
                                                   quantities.reaction_sets(), hardening));
    result.setup_s = now() - started;
    const double solving = now();
    int status = 0;
    std::exception_ptr stopped;
    try {
      status = run_program(program, place.folder(), request.threads, [&] {
        scene::check_interrupt();
        if (!request.progress) return;
        const Progress reached = progress_of(place);
        request.progress(reached.time, fmt::format("increment {}", reached.increments));
      });
    } catch (const Interrupted&) {
      stopped = std::current_exception();
    }
    result.wall_s = now() - solving;
    const Progress reached = progress_of(place);
    result.steps = reached.iterations;
    result.notes["program"] = "CalculiX " + program_version(place / "job.log");
    Report report(problem, request, mesh, quantities, result);
    const int done = collect(place,
                             {options.steps, quantities.reaction_sets().size(),
                              problem.material.plastic(), reached.time},
                             mesh, report);
    if (stopped) std::rethrow_exception(stopped);
    scene::check_interrupt();  // the signal may have ended CalculiX first
    if (status == 0 && done == options.steps) return;
    throw SolveError("CalculiX", done, reached.time, -1,
                     fmt::format("{} of {} load steps done, exit status {}; its last words:{}",
                                 done, options.steps, status, log_tail(place / "job.log")));
  }

 private:
  /// Reads what is there and reports it; the number of load steps.
  static int collect(const Workplace& place, const RecordRequest& wanted,
                     const scene::Mesh& mesh, Report& report) {
    report.add(zero_record(mesh, wanted));
    const std::vector<Record> records = read_records(place.folder(), mesh, wanted);
    for (const Record& record : records) report.add(record);
    report.finish();
    return static_cast<int>(records.size());
  }
};

const scene::RegisterMethod<Calculix> registered;

}  // namespace
}  // namespace concord::calculix
