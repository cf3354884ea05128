#include "fem_reference/calculix/records.hpp"

#include "fem_reference/calculix/result_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

namespace concord::calculix {
namespace {

// Points per element that CalculiX prints: a plane element is one layer of C3D15 with three
// points across its thickness.
constexpr std::size_t points_2d = 9, points_3d = 4;

class Collector {
 public:
  Collector(const scene::Mesh& mesh, const RecordRequest& request)
      : m_mesh(mesh), m_request(request), m_slots(static_cast<std::size_t>(request.steps) + 1) {
    for (Slot& slot : m_slots) slot.have_reaction.assign(request.reactions, false);
  }

  void take(const DatTable& table) {
    Slot* slot = slot_at(table.time);
    if (slot == nullptr) return;
    if (table.quantity == "displacements") displacements(table, *slot);
    if (table.quantity == "total force") reaction(table, *slot);
    if (table.quantity == "equivalent plastic strain") gauss_strain(table, *slot);
  }

  void take(const FrdBlock& block) {
    Slot* slot = slot_at(block.time);
    if (slot == nullptr || block.nodes.size() < m_mesh.nodes.size()) return;
    if (block.name == "STRESS" && block.components == 6 && slot->record.stress.empty())
      stress(block, slot->record);
    if (block.name == "PE" && block.components == 1 && slot->record.plastic_strain.empty()) {
      slot->record.plastic_strain.assign(m_mesh.nodes.size(), 0);
      for (std::size_t k = 0; k < block.nodes.size(); ++k)
        if (const auto n = node(block.nodes[k]))
          slot->record.plastic_strain[*n] = block.values[k];
    }
  }

  std::vector<Record> whole() {
    std::vector<Record> out;
    for (std::size_t k = 1; k < m_slots.size() && is_whole(m_slots[k]); ++k) {
      out.push_back(std::move(m_slots[k].record));
      out.back().t = static_cast<double>(k) / m_request.steps;
    }
    return out;
  }

 private:
  struct Slot {
    Record record;
    std::vector<bool> have_reaction;
    bool have_gauss = false;
  };

  /// CalculiX prints times with 6 or 7 digits.
  Slot* slot_at(double t) {
    const double k = std::round(t * m_request.steps);
    if (k < 1 || k > m_request.steps || t > m_request.t_reached * (1 + 2e-6)) return nullptr;
    if (std::abs(t * m_request.steps - k) > 5e-6 * k + 5e-4) return nullptr;
    return &m_slots[static_cast<std::size_t>(k)];
  }
  std::optional<std::size_t> node(double number) const {
    if (!(number >= 1) || number > static_cast<double>(m_mesh.nodes.size()))
      return std::nullopt;
    return static_cast<std::size_t>(number) - 1;
  }

  void displacements(const DatTable& table, Slot& slot) const {
    if (table.columns != 4 || table.rows() != m_mesh.nodes.size() || !slot.record.u.empty())
      return;
    slot.record.u.assign(m_mesh.nodes.size(), Vec3::Zero());
    for (std::size_t r = 0; r < table.rows(); ++r) {
      const double* row = &table.values[4 * r];
      if (const auto n = node(row[0]))
        for (int i = 0; i < m_mesh.dim; ++i) slot.record.u[*n][i] = row[i + 1];
    }
  }
  void reaction(const DatTable& table, Slot& slot) const {
    std::size_t set = 0;
    const std::string_view digits =
        std::string_view(table.set).substr(table.set.empty() ? 0 : 1);
    if (std::from_chars(digits.data(), digits.data() + digits.size(), set).ec != std::errc())
      return;
    if (set >= m_request.reactions || slot.have_reaction[set] || table.values.size() != 3)
      return;
    slot.have_reaction[set] = true;
    slot.record.reactions.resize(m_request.reactions, Vec3::Zero());
    for (int i = 0; i < m_mesh.dim; ++i)
      slot.record.reactions[set][i] = table.values[static_cast<std::size_t>(i)];
  }
  void gauss_strain(const DatTable& table, Slot& slot) const {
    const std::size_t points = m_mesh.dim == 2 ? points_2d : points_3d;
    if (table.columns != 3 || table.rows() != points * m_mesh.cell_count() || slot.have_gauss)
      return;
    slot.have_gauss = true;
    for (std::size_t r = 0; r < table.rows(); ++r)
      slot.record.gauss_plastic_strain_max =
          std::max(slot.record.gauss_plastic_strain_max, table.values[3 * r + 2]);
  }
  void stress(const FrdBlock& block, Record& record) const {
    record.stress.assign(m_mesh.nodes.size(), Mat3::Zero());
    for (std::size_t k = 0; k < block.nodes.size(); ++k) {
      const auto n = node(block.nodes[k]);
      if (!n) continue;
      const double* s = &block.values[6 * k];  // xx yy zz xy yz zx
      record.stress[*n] << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    }
  }
  bool is_whole(const Slot& slot) const {
    if (slot.record.u.empty() || slot.record.stress.empty()) return false;
    if (m_request.plastic && (slot.record.plastic_strain.empty() || !slot.have_gauss))
      return false;
    return std::find(slot.have_reaction.begin(), slot.have_reaction.end(), false) ==
           slot.have_reaction.end();
  }

  const scene::Mesh& m_mesh;
  RecordRequest m_request;
  std::vector<Slot> m_slots;
};

}  // namespace

Record zero_record(const scene::Mesh& mesh, const RecordRequest& request) {
  Record record;
  record.u.assign(mesh.nodes.size(), Vec3::Zero());
  record.reactions.assign(request.reactions, Vec3::Zero());
  record.stress.assign(mesh.nodes.size(), Mat3::Zero());
  if (request.plastic) record.plastic_strain.assign(mesh.nodes.size(), 0);
  return record;
}

std::vector<Record> read_records(const std::filesystem::path& folder, const scene::Mesh& mesh,
                                 const RecordRequest& request) {
  Collector collector(mesh, request);
  std::ifstream dat(folder / "job.dat"), frd(folder / "job.frd");
  read_dat(dat, [&](const DatTable& table) { collector.take(table); });
  read_frd(frd, [&](const FrdBlock& block) { collector.take(block); });
  return collector.whole();
}

}  // namespace concord::calculix
