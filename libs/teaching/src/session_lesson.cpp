// Which lesson comes next, and what it teaches.

#include <algorithm>
#include <optional>
#include <utility>

#include "imagined_people.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "kith/core/math.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/teaching/session.hpp"
#include "kith/teaching/test_selection.hpp"
#include "session_checks.hpp"
#include "whole_components.hpp"

namespace kith {

struct Session::Prepared {
  Lesson lesson;
  std::shared_ptr<const Strategy> strategy;
  VisitedStarts visited;
  std::vector<HalfSpace> taught_with_unit;
};

// Whether the lessons leave something open of a component that was skipped, from the component on.
bool Session::is_anything_open(TeachingCache& cache, std::size_t component) const {
  auto known = atlas_->prior();
  for (const auto& period : history_) known |= cache.numbers_of(period.lesson.taught);
  known = cache.regions().minimal(known);
  for (; component < components_.size(); ++component) {
    if (components_[component] != ComponentStatus::kSkipped) continue;
    const auto& facets = atlas_->knowledge_components()[component].constraints;
    if (!open_facets(cache, facets, known).empty()) return true;
  }
  return false;
}

bool Session::propose(TeachingCache& cache, std::span<const MemberTruth> truth) {
  if (finished()) return false;
  require_phase(SessionPhase::kProposal, "choosing a lesson");
  require(&cache.atlas() == atlas_.get(), "the cache is of another atlas");
  require(truth.empty() || truth.size() == num_members(), "the truth is that of another team");
  if (awaits_newcomer()) {
    Session trial = *this;  // should the choice fail, nothing has changed
    trial.admit_newcomers(cache);
    const bool has_lesson = trial.propose(cache, truth);
    *this = std::move(trial);
    return has_lesson;
  }
  std::vector<bool> present;
  for (const Attendance seat : attendance_)
    present.push_back(seat == Attendance::kPresent || seat == Attendance::kReturning);
  if (nobody(present)) throw Error{ErrorKind::kUsage, "no lesson can be chosen: everybody is away"};
  cache.trim();

  std::optional<TeamBelief> others;  // if other members take part than before
  if (belief_.present() != present) others.emplace(belief_).set_present(present);
  std::optional<Prepared> prepared;
  auto component = component_;
  for (; component < components_.size(); ++component) {
    prepared = prepare(cache, component, others ? *others : belief_, truth);
    if (prepared) break;
  }
  auto proposed = events_.prepare(LessonProposed{});

  // From here on nothing fails.
  events_.push_back(std::move(proposed));
  if (others) belief_ = *std::move(others);
  for (Attendance& seat : attendance_) seat = seat == Attendance::kReturning ? Attendance::kPresent : seat;
  for (; component_ < component; ++component_) components_[component_] = ComponentStatus::kSkipped;
  if (!prepared) {
    // Those that are left out by design do not count.
    const auto first = teaches_whole() ? components_.end() - 1 : components_.begin();
    status_ = is_anything_open(cache, static_cast<std::size_t>(first - components_.begin())) ? SessionStatus::kSkipped
                                                                                             : SessionStatus::kComplete;
    phase_ = SessionPhase::kFinished;
    return false;
  }
  lesson_ = std::move(prepared->lesson);
  strategy_ = std::move(prepared->strategy);
  visited_ = std::move(prepared->visited);
  taught_with_unit_ = std::move(prepared->taught_with_unit);
  phase_ = SessionPhase::kLesson;
  return true;
}

const Lesson* Session::last_of_component(std::size_t component) const {
  if (history_.empty() || history_.back().lesson.component != component) return nullptr;
  return &history_.back().lesson;
}

TeachingView Session::view(const TeamBelief& belief, std::size_t component) const {
  return {.atlas = *atlas_,
          .options = options_,
          .belief = belief,
          .history = history_,
          .last_of_component = last_of_component(component),
          .taught_region = taught_before_,
          .visited = visited_,
          .tie_breaks = tie_breaks_,
          .period = periods() + 1,
          .component = component,
          .bank = bank_ ? &*bank_ : nullptr,
          .has_short_lessons = choice_.kind.teaches_whole};
}

// The lesson of one component; nothing if there is nothing to teach.
std::optional<Session::Prepared> Session::prepare(TeachingCache& cache, std::size_t component, const TeamBelief& belief,
                                                  std::span<const MemberTruth> truth) const {
  const auto random = teacher_.split("lesson").split(periods()).split(component);
  const auto* last = last_of_component(component);
  Prepared next{{}, {}, visited_, taught_with_unit_};
  auto seen = view(belief, component);
  seen.truth = truth;
  UnitSelector select{cache,
                      seen,
                      {.counterfactuals = options_.counterfactuals,
                       .sampling = options_.sampling,
                       .likelihood = belief.options().likelihood,
                       .max_demonstrations = options_.max_demonstrations,
                       .avoids_repeats = options_.avoids_repeats}};
  auto strategy = strategy_->clone();
  auto proposal = strategy->propose(seen, select, random.split("demonstrations"));
  if (proposal.unit.demonstrations.empty() && last == nullptr) select.complete(proposal.unit, random.split("open"));
  next.strategy = std::move(strategy);

  Lesson& lesson = next.lesson;
  if (!proposal.unit.demonstrations.empty()) {
    for (const auto& shown : proposal.unit.demonstrations) next.visited.insert(shown.start);
    describe(lesson, proposal.unit, cache);
    lesson.demonstrations = std::move(proposal.unit.demonstrations);
    next.taught_with_unit = std::move(proposal.unit.taught_region);
  } else if (last != nullptr) {
    lesson = *last;
    lesson.repeats = true;
    lesson.gain = 0.0;
  } else {
    return std::nullopt;
  }
  lesson.period = periods() + 1;
  lesson.component = component;
  lesson.source = std::move(proposal.source);
  VisitedStarts demonstrated{atlas_->num_states()};
  for (const auto& period : history_) {
    for (const auto& shown : period.lesson.demonstrations) demonstrated.insert(shown.start);
  }
  for (const auto& shown : lesson.demonstrations) demonstrated.insert(shown.start);
  lesson.tests = std::move(proposal.tests);
  for (const auto& test : lesson.tests) next.visited.insert(test.start);
  const auto examined = lesson.tests.empty() ? to_examine(lesson, cache) : std::vector<HalfSpace>{};
  const TestPreferences preferences{cache, demonstrated, options_.avoids_shortest};
  for (std::size_t set = 0; !examined.empty() && set < options_.duplicate_sets; ++set) {
    auto choice =
        select_tests(*atlas_, atlas_->knowledge_components()[component], lesson.demonstrations, examined, next.visited,
                     random.split("tests").split(set), options_.avoids_repeats ? &preferences : nullptr);
    lesson.untested = choice.untested;
    lesson.tests.insert(lesson.tests.end(), choice.tests.begin(), choice.tests.end());
  }
  for (auto& test : lesson.tests) test.is_shortest_wrong = cache.is_shortest_wrong(test.start);
  lesson.tests_demonstrated = static_cast<std::size_t>(
      std::ranges::count_if(lesson.tests, [&](const Test& test) { return demonstrated.contains(test.start); }));
  return next;
}

// What the unit teaches, and how much that is.
void Session::describe(Lesson& lesson, const Unit& unit, TeachingCache& cache) const {
  auto conveyed = atlas_->prior();
  for (const auto& shown : unit.demonstrations) conveyed |= cache.numbers_of(shown.half_spaces);
  const auto& region = cache.regions().of(conveyed);
  lesson.taught = cache.constraints().half_spaces(region.minimal.without(atlas_->prior()));
  lesson.area_sr = region.area_sr;
  lesson.running_area_sr = cache.regions().of(cache.numbers_of(unit.taught_region)).area_sr;
  lesson.gain = math::log(cache.regions().of(cache.numbers_of(taught_before_)).area_sr / lesson.running_area_sr);
}

// What the tests of a lesson ask about: what it teaches and, where whole components are taught, also the facets of the
// component's region that do not follow from that. Whoever answers everything right is done with the component.
std::vector<HalfSpace> Session::to_examine(const Lesson& lesson, TeachingCache& cache) const {
  auto examined = lesson.taught;
  if (!teaches_whole_components(*atlas_)) return examined;
  const auto taught = atlas_->prior() | cache.numbers_of(lesson.taught);
  Cone region{atlas_->domain().num_features()};
  const bool has_room = region.clip(cache.constraints().half_spaces(taught));
  KITH_ASSERT(has_room);  // the robot's weights lie inside
  const auto& component = atlas_->knowledge_components()[lesson.component];
  for (const auto& facet : atlas_->constraints().half_spaces(component.constraints)) {
    if (!region.implies(facet)) examined.push_back(facet);
  }
  std::sort(examined.begin(), examined.end());
  return examined;
}

}  // namespace kith
