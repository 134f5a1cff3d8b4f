#pragma once

#include <vector>

#include "kith/explain/audit_report.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/observed_period.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {

/// Somebody whose answers are to be judged.
struct ObservedPerson {
  AuditedPerson person;  ///< Without audit and kinds.
  std::vector<ObservedPeriod> periods;
};

/// How people are judged who were taught with these options. @param forgetting  AuditOptions::forgetting.
[[nodiscard]] AuditOptions audit_options(const TeachingOptions& teaching, double forgetting);

/// The people of one group, with their audits, and with their kinds if `teaching` asks for them. The team and the room
/// of the first one address the random numbers, so that the result depends on nothing else that is audited.
[[nodiscard]] std::vector<AuditedPerson> audit_people(TeachingCache& cache, const TeachingOptions& teaching,
                                                      double forgetting, std::vector<ObservedPerson> group);

/// The members of a team of a run, with the options of its variant.
[[nodiscard]] std::vector<AuditedPerson> audit_team(TeachingCache& cache, const Study& study, const TeamRecord& record,
                                                    double forgetting);

}  // namespace kith
