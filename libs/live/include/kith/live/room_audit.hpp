#pragma once

#include <vector>

#include "kith/explain/audit_report.hpp"
#include "kith/live/live_study.hpp"
#include "kith/live/room.hpp"
#include "kith/live/taught_people.hpp"

namespace kith {

/// AuditOptions::forgetting, unless somebody says otherwise.
inline constexpr double kForgetting = 0.02;

/// The one judgement of who of a room understands what: pages, tables, reports and `kith audit` all take it from here.
/// @param people  as from TaughtPeople::all().
[[nodiscard]] std::vector<AuditedPerson> audit_room(TeachingCache& cache, const LiveStudy& study,
                                                    const RoomSetup& setup, std::vector<TaughtPerson> people,
                                                    double forgetting = kForgetting);

/// What facilitators see of it, one entry per person with a lesson: seat, member,
/// tests, right, knows, components, and where there is something to say needs_help, thinks with its probability, kind
/// and kinds.
[[nodiscard]] Json people_json(const Atlas& atlas, const std::vector<AuditedPerson>& people);

}  // namespace kith
