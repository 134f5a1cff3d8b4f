#include "cases.hpp"

#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith::bench {

const Atlas& Workbench::atlas() {
  if (!atlas_) atlas_ = std::make_unique<const Atlas>(load_domain("item-delivery"));
  return *atlas_;
}

StudyReading Workbench::study(const std::string& name) {
  auto reading = load_study(name);
  if (!reading.study) throw Error{reading.diagnostics};
  return reading;
}

const std::vector<Case>& all_cases() {
  static const std::vector<Case> kCases = [] {
    std::vector<Case> cases;
    add_belief_cases(cases);
    add_geometry_cases(cases);
    add_planning_cases(cases);
    add_study_cases(cases);
    return cases;
  }();
  return kCases;
}

}  // namespace kith::bench
