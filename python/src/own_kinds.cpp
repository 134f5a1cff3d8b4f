#include "own_kinds.hpp"

#include <set>

namespace kith::python {

OwnKinds::OwnKinds() {
  strategies_.assign(strategy_kinds().begin(), strategy_kinds().end());
  for (const auto& [kind, slot] : detail::own_strategies()) strategies_.push_back(kind);
  learners_.assign(learner_models().begin(), learner_models().end());
  for (const auto* slot : detail::own_learners()) learners_.push_back(&slot->model);
}

std::string OwnKinds::used_by(const std::vector<StudySpec>& variants) const {
  std::set<std::string_view> names;
  for (const auto& spec : variants) {
    for (const auto& choice : spec.strategies) names.insert(choice.kind.name);
    for (const auto& type : spec.learner_types) names.insert(type.model->kind);
  }
  std::string used;
  const auto add = [&](const std::string& name, const std::string& version) {
    if (names.count(name) > 0) used += (used.empty() ? "" : ", ") + name + (version.empty() ? "" : " " + version);
  };
  for (const auto& [kind, slot] : detail::own_strategies()) add(slot->name, slot->version);
  for (const auto* slot : detail::own_learners()) add(slot->name, slot->version);
  return used;
}

void bind_own_kinds(py::module_& module) {
  detail::bind_own_strategies(module);
  detail::bind_own_learners(module);
}

}  // namespace kith::python
