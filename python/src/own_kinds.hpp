#pragma once

#include <string>
#include <vector>

#include "binding.hpp"
#include "kith/study/study_spec.hpp"

namespace kith::python {

/// The rows of the registries with those that are written in Python: what studies can name. A class of the same name
/// takes the place of the one before.
class OwnKinds {
 public:
  OwnKinds();
  [[nodiscard]] StudyKinds kinds() const { return {learners_, strategies_, aggregation_rules()}; }
  [[nodiscard]] const std::vector<StrategyKind>& strategies() const noexcept { return strategies_; }
  /// "mine 2, yours": the names with their versions, for the identity of a run that uses them.
  [[nodiscard]] std::string used_by(const std::vector<StudySpec>& variants) const;

 private:
  std::vector<StrategyKind> strategies_;
  std::vector<const LearnerModel*> learners_;
};

namespace detail {
struct StrategySlot {
  std::string name, description, version{};
  TeamBeliefNeeds needs{};
  PyObject* make = nullptr;  // never released: the interpreter may end before the last use
};
struct LearnerSlot {
  std::string name, description, version{};
  PyObject* make = nullptr;
  LearnerModel model{};
};
/// Those in use, in the order of registration. Rows stay where they are for ever.
[[nodiscard]] std::vector<std::pair<StrategyKind, const StrategySlot*>> own_strategies();
[[nodiscard]] std::vector<const LearnerSlot*> own_learners();
void bind_own_strategies(py::module_& module);
void bind_own_learners(py::module_& module);
}  // namespace detail

}  // namespace kith::python
