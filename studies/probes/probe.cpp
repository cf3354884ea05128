#include "studies/probes/probe.hpp"

#include "scene/suggest.hpp"

#include <stdexcept>

namespace concord::probes {

std::unique_ptr<scene::DiscreteBody> ProbeRequest::body(const scene::RunRequest& other) const {
  const auto* discretises = dynamic_cast<const scene::Discretises*>(&method);
  if (discretises == nullptr) {
    throw InputError({"command line"}, "--method", scene::in_quotes(method.info().name),
                     "a method that shows its discretised body");
  }
  return discretises->discretise(problem, other);
}

ProbeRegistry& ProbeRegistry::instance() {
  static ProbeRegistry registry;
  return registry;
}

void ProbeRegistry::add(std::unique_ptr<Probe> probe) {
  const std::string name = probe->info().name;
  if (!m_probes.emplace(name, std::move(probe)).second)
    throw std::logic_error("two probes are named " + name);
}

const Probe& ProbeRegistry::find(const std::string& name) const {
  const auto found = m_probes.find(name);
  if (found != m_probes.end()) return *found->second;
  std::vector<std::string> names;
  for (const auto& [known, probe] : m_probes) names.push_back(known);
  throw InputError({"command line"}, "TEST", scene::in_quotes(name),
                   scene::allowed_words(name, names));
}

std::vector<const Probe*> ProbeRegistry::all() const {
  std::vector<const Probe*> probes;
  for (const auto& [name, probe] : m_probes) probes.push_back(probe.get());
  return probes;
}

scene::ParameterInfo number_option(std::string key, std::string unit, std::string value,
                                   double minimum, double maximum, std::string range,
                                   std::string meaning) {
  scene::ParameterInfo info;
  info.key = std::move(key), info.unit = std::move(unit), info.default_value = std::move(value);
  info.range = std::move(range), info.meaning = std::move(meaning);
  info.minimum = minimum, info.maximum = maximum;
  return info;
}

scene::ParameterInfo word_option(std::string key, std::string value,
                                 std::vector<std::string> choices, std::string meaning) {
  scene::ParameterInfo info;
  info.key = std::move(key), info.unit = "1", info.default_value = std::move(value);
  for (const std::string& choice : choices)
    info.range += (info.range.empty() ? "" : " | ") + choice;
  info.choices = std::move(choices), info.meaning = std::move(meaning);
  return info;
}

}  // namespace concord::probes
