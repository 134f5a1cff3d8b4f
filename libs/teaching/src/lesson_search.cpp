#include "lesson_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "kith/core/math.hpp"
#include "kith/teaching/imitation_table.hpp"
#include "test_order.hpp"
#include "unit_of.hpp"
#include "visual_order.hpp"

namespace kith {
namespace {

constexpr double kTie = 1e-12;             // losses within this are equal
constexpr std::size_t kFirstKept = 12;     // candidates to which tests are added
constexpr std::size_t kLaterKept = 4;      // the same of those that are added to a lesson
constexpr std::size_t kMostExamined = 64;  // constraints of which tests are chosen

// Whether a lesson is made longer: it has to lower the loss by a quarter more per item, as after the shorter one the
// teacher knows answers.
bool is_worth(double longer, double shorter) { return longer > shorter + 0.25 * std::abs(shorter); }

// Demonstrations that convey the same to one of the groups.
struct Candidate {
  ConstraintSet conveyed;                  // minimal
  const ImaginedPeople* people = nullptr;  // never null
  std::vector<StartClassIndex> classes;
};

// What people who imitate get wrong, on the starts of an ImitationTable.
class LossOfImitation {
 public:
  // @param history  of what was shown before.
  LossOfImitation(ImitationTable& table, const Imitation& imitation, bool by_share, const PastPeriods& history)
      : table_{table},
        temperature_{imitation.temperature},
        by_share_{by_share},
        wrong_(table.num_starts(), 0.0),
        weight_(table.num_starts(), 0.0) {
    for (const auto& period : history) {
      for (const auto& shown : period.lesson.demonstrations) add(shown.start);
    }
  }

  void add(StartIndex demonstration) {
    const auto row = table_.of(demonstration);
    for (std::size_t s = 0; s < row.size(); ++s) {
      const double similarity = math::exp(-row[s].distance / temperature_);
      weight_[s] += similarity;
      wrong_[s] += similarity * wrong(row[s].grade);
    }
  }

  [[nodiscard]] double now() const {
    double sum = 0.0;
    for (std::size_t s = 0; s < wrong_.size(); ++s) sum += weight_[s] > 0.0 ? wrong_[s] / weight_[s] : 0.0;
    return sum / static_cast<double>(std::max<std::size_t>(wrong_.size(), 1));
  }
  // Of some demonstrations of these classes, spread over them, the best.
  [[nodiscard]] StartIndex best_of(const Atlas& atlas, std::span<const StartClassIndex> classes,
                                   const VisitedStarts& met) const {
    constexpr std::size_t kCompared = 24;
    std::vector<StartIndex> fresh;
    for (const auto c : classes) {
      for (const auto start : atlas.members(c)) {
        if (!met.contains(start)) fresh.push_back(start);
      }
    }
    const auto n = std::min(kCompared, fresh.size());
    StartIndex best;
    double least = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto start = fresh[i * fresh.size() / n];
      const double wrong = with(start);
      if (i > 0 && !(wrong < least)) continue;
      least = wrong;
      best = start;
    }
    return best;
  }

  // If this were shown, too.
  [[nodiscard]] double with(StartIndex demonstration) const {
    const auto row = table_.of(demonstration);
    double sum = 0.0;
    for (std::size_t s = 0; s < row.size(); ++s) {
      const double similarity = math::exp(-row[s].distance / temperature_);
      const double weight = weight_[s] + similarity;
      if (weight > 0.0) sum += (wrong_[s] + similarity * wrong(row[s].grade)) / weight;
    }
    return sum / static_cast<double>(std::max<std::size_t>(row.size(), 1));
  }

 private:
  [[nodiscard]] double wrong(const Grade& grade) const { return by_share_ ? 1.0 - grade.share_right : grade.regret; }

  ImitationTable& table_;
  double temperature_;
  bool by_share_;
  std::vector<double> wrong_, weight_;  // summed over what was shown, shape [starts]
};

// The constraints of a set in the order in which people meet them.
std::vector<ConstraintIndex> in_order(const ConstraintTable& constraints, const ConstraintSet& set) {
  auto members = set.members();
  std::sort(members.begin(), members.end(),
            [&](ConstraintIndex a, ConstraintIndex b) { return constraints[a].normal() < constraints[b].normal(); });
  return members;
}

class LessonSearch {
 public:
  LessonSearch(TeachingCache& cache, const TeachingView& view, LessonLoss& loss, std::span<const ImaginedPeople> groups,
               const LessonLimits& limits, const RandomStream& random)
      : cache_{cache},
        atlas_{view.atlas},
        view_{view},
        loss_{loss},
        limits_{limits},
        random_{random},
        known_{view.atlas.prior()},
        is_shown_(view.atlas.num_states(), false),
        covered_(view.atlas.num_states(), 0) {
    for (const auto start : view.visited.in_order()) is_shown_[atlas_.trajectory_class(start)] = true;
    if (loss.imitation().probability > 0.0) {
      imitation_.emplace(cache.imitation(), loss.imitation(), loss.objective() == TeachingObjective::kRight,
                         view.history);
    }
    for (const auto& past : view.history) known_ |= cache.numbers_of(past.lesson.taught);
    known_ = cache.regions().minimal(known_);
    nothing_ = loss.of(loss.before(), imitation_ ? imitation_->now() : 0.0);
    for (const auto& people : groups) find_candidates(people);
  }

  [[nodiscard]] UnitProposal best() {
    Lesson lesson{.met = view_.visited, .product = loss_.before()};
    while (lesson.shown.size() < limits_.demonstrations) {
      auto longer = extended(lesson);
      if (!longer || (!lesson.shown.empty() && !is_worth(longer->ratio, lesson.ratio))) break;
      lesson = *std::move(longer);
      if (imitation_) imitation_->add(lesson.shown.back().start);
    }
    UnitProposal proposal{SourceBelief::of_everybody(), {}, {}};
    if (lesson.shown.empty()) return proposal;
    proposal.unit = unit_of(cache_, view_, lesson.shown);
    const TestPreferences preferences{cache_, view_.visited, view_.options.avoids_shortest};
    for (const auto& chosen : lesson.tests) {
      Test test;
      test.start = test_to_ask(atlas_, starts_of(chosen, lesson), proposal.unit.demonstrations, random_.split("tests"),
                               &preferences);
      test.covered = cache_.constraints().half_spaces(chosen.covered);
      std::sort(test.covered.begin(), test.covered.end());
      proposal.tests.push_back(std::move(test));
    }
    return proposal;
  }

 private:
  // What starts examine.
  struct Examined {
    ConstraintSet covered;
    ConstraintSet among;  // what was taught
  };
  struct Lesson {
    std::vector<ShownTo> shown{};
    std::vector<Examined> tests{};
    VisitedStarts met;
    LessonLoss::Product product;      // after the demonstrations
    ConstraintSet taken{}, missed{};  // of what they convey, by people of limited capacity
    double ratio = 0.0;
  };

  void find_candidates(const ImaginedPeople& people) {
    const auto& component = atlas_.knowledge_components()[view_.component];
    const auto conveyed = cache_.behaviours().conveyed_by_class(component, people.cells);
    std::unordered_map<ConstraintSet, std::size_t> by_row;  // most classes share theirs with others
    for (const auto c : component.start_classes) {
      auto row = conveyed.set(c);
      if (row.empty()) continue;
      const auto [same, is_new] = by_row.try_emplace(std::move(row), 0);
      if (is_new) {
        const auto& minimal = cache_.regions().minimal(same->first);
        const auto place = by_minimal_.try_emplace(minimal, candidates_.size());
        if (place.second) candidates_.push_back({minimal, &people, {}});
        same->second = place.first->second;
      }
      auto& candidate = candidates_[same->second];
      if (candidate.people == &people) candidate.classes.push_back(c);
    }
  }

  // The lesson with the demonstration, and the tests to it, by which the loss falls most per item; nothing if there is
  // none. What nobody has met comes first, as long as it helps.
  [[nodiscard]] std::optional<Lesson> extended(const Lesson& lesson) {
    struct Rated {
      double loss;
      std::size_t candidate;
    };
    std::vector<Rated> fresh, known;
    LessonLoss::Product product;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const auto& candidate = candidates_[i];
      const bool is_new =
          std::ranges::any_of(candidate.classes, [&](auto c) { return has_unvisited(atlas_, c, lesson.met); });
      product = lesson.product;
      show(lesson, candidate.conveyed, product);
      // What imitators copy depends on the start, which else is chosen by its looks once it matters.
      const double imitating = imitation_ ? imitation_->with(start_of(candidate, lesson)) : 0.0;
      (is_new ? fresh : known).push_back({loss_.of(product, imitating), i});
    }
    const auto falls = [&](const Rated& one) { return one.loss < nothing_ - kTie; };
    auto& rated = std::ranges::any_of(fresh, falls) || known.empty() ? fresh : known;
    if (rated.empty()) return std::nullopt;
    std::ranges::stable_sort(rated, {}, &Rated::loss);
    const auto kept = std::min(lesson.shown.empty() ? kFirstKept : kLaterKept, rated.size());
    std::optional<Lesson> best;
    for (std::size_t i = 0; i < kept; ++i) {
      auto longer = with_tests(lesson, candidates_[rated[i].candidate]);
      if (!best || longer.ratio > best->ratio + kTie) best = std::move(longer);
    }
    return best;
  }

  // What people take in of a demonstration after those of the lesson. @return what they do not.
  ConstraintSet show(const Lesson& lesson, const ConstraintSet& conveyed, LessonLoss::Product& product,
                     ConstraintSet* taken = nullptr) {
    if (limits_.capacity == 0) {
      loss_.show(product, conveyed);
      return {};
    }
    auto all = lesson.taken;
    ConstraintSet own, missed;
    for (const auto c : in_order(cache_.constraints(), conveyed)) {
      if (!all.contains(c) && all.count() == limits_.capacity) {
        missed.insert(c);
      } else {
        all.insert(c);
        own.insert(c);
      }
    }
    loss_.show(product, own);
    if (taken != nullptr) *taken = std::move(all);
    return missed;
  }

  [[nodiscard]] StartIndex start_of(const Candidate& candidate, const Lesson& lesson) const {
    const bool is_new =
        std::ranges::any_of(candidate.classes, [&](auto c) { return has_unvisited(atlas_, c, lesson.met); });
    const VisitedStarts nothing{atlas_.num_states()};
    const auto& met = is_new ? lesson.met : nothing;
    if (imitation_) return imitation_->best_of(atlas_, candidate.classes, met);
    std::vector<Demonstration> unit;
    for (const auto& shown : lesson.shown) unit.emplace_back().start = shown.start;
    return simplest_of(atlas_, candidate.classes, met, unit, random_.split("looks").split(unit.size()));
  }

  [[nodiscard]] Lesson with_tests(const Lesson& lesson, const Candidate& candidate) {
    Lesson longer{.shown = lesson.shown, .met = lesson.met, .product = lesson.product, .missed = lesson.missed};
    const auto start_index = start_of(candidate, lesson);
    longer.shown.push_back({start_index, candidate.conveyed, candidate.people});
    longer.met.insert(start_index);
    longer.missed |= show(lesson, candidate.conveyed, longer.product, &longer.taken);
    const double imitating = imitation_ ? imitation_->with(start_index) : 0.0;
    auto taught = known_;
    for (const auto& shown : longer.shown) taught |= shown.conveyed;
    const auto all = examined(cache_.regions().minimal(taught).without(atlas_.prior()).without(longer.missed), longer);

    const auto ratio = [&](double loss, std::size_t tests) {
      return (nothing_ - loss) / static_cast<double>(longer.shown.size() + tests);
    };
    longer.ratio = ratio(loss_.of(longer.product, imitating), 0);
    auto product = longer.product;
    LessonLoss::Product after;
    ConstraintSet heard;
    while (longer.tests.size() < limits_.tests) {
      const Examined* best = nullptr;
      double least = 0.0;
      for (const bool again : {false, true}) {  // what was met already only if nothing else helps
        for (const auto& one : all.at(again ? 1 : 0)) {
          const auto added = one.covered.without(heard);
          if (added.empty()) continue;
          after = product;
          loss_.repeat(after, added);
          const double loss = loss_.of(after, imitating);
          if (best != nullptr && !(loss < least - kTie)) continue;
          least = loss;
          best = &one;
        }
        if (best != nullptr) break;
      }
      if (best == nullptr) break;
      const double longer_ratio = ratio(least, longer.tests.size() + 1);
      if (!longer.tests.empty() && !is_worth(longer_ratio, longer.ratio)) break;
      longer.ratio = longer_ratio;
      loss_.repeat(product, best->covered.without(heard));
      heard |= best->covered;
      longer.tests.push_back(*best);
    }
    return longer;
  }

  // What starts examine of what was taught, each set once: of those that nobody has met, and of the others.
  [[nodiscard]] std::array<std::vector<Examined>, 2> examined(const ConstraintSet& taught, const Lesson& lesson) {
    auto members = taught.members();
    if (members.size() > kMostExamined) members.resize(kMostExamined);
    std::array<std::vector<Examined>, 2> result;
    std::array<std::unordered_set<std::uint64_t>, 2> known;
    for (const auto start : examining(members)) {
      const auto mask = std::exchange(covered_[start.value()], 0);
      if (is_of(lesson, start)) continue;
      const std::size_t again = is_shown(lesson, start) ? 1 : 0;
      if (!known[again].insert(mask).second) continue;
      auto& one = result[again].emplace_back();
      for (std::size_t i = 0; i < members.size(); ++i) {
        if ((mask >> i & 1u) != 0) one.covered.insert(members[i]);
      }
      one.among = taught;
    }
    return result;
  }

  // The starts that examine just this of what was taught, ascending.
  [[nodiscard]] std::vector<StartIndex> starts_of(const Examined& examined, const Lesson& lesson) {
    auto members = examined.among.members();
    if (members.size() > kMostExamined) members.resize(kMostExamined);
    std::uint64_t wanted = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (examined.covered.contains(members[i])) wanted |= std::uint64_t{1} << i;
    }
    std::array<std::vector<StartIndex>, 2> starts;
    for (const auto start : examining(members)) {
      const auto mask = std::exchange(covered_[start.value()], 0);
      if (mask == wanted && !is_of(lesson, start)) starts[is_shown(lesson, start) ? 1 : 0].push_back(start);
    }
    auto& chosen = starts[starts[0].empty() ? 1 : 0];
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

  // The starts that examine some of these, each once; bit i of covered_ says that one examines members[i]. Where people
  // bring up what no start tests, those examine it whose demonstration would convey it.
  [[nodiscard]] std::vector<StartIndex> examining(const std::vector<ConstraintIndex>& members) {
    const auto& component = atlas_.knowledge_components()[view_.component];
    std::vector<StartIndex> starts;
    const auto examine = [&](StartIndex start, std::size_t i) {
      auto& covered = covered_[start.value()];
      if (covered == 0) starts.push_back(start);
      covered |= std::uint64_t{1} << i;
    };
    for (std::size_t i = 0; i < members.size(); ++i) {
      bool is_tested = false;
      for (const auto start : atlas_.tests_for(members[i])) {
        if (!component.uses_mdp[atlas_.id(start).mdp.value()]) continue;
        is_tested = true;
        examine(start, i);
      }
      for (const auto& candidate : candidates_) {
        if (is_tested || !candidate.conveyed.contains(members[i])) continue;
        for (const auto c : candidate.classes) {
          for (const auto start : atlas_.members(c)) examine(start, i);
        }
      }
    }
    return starts;
  }
  [[nodiscard]] static bool is_of(const Lesson& lesson, StartIndex start) {
    return std::ranges::any_of(lesson.shown, [&](const auto& shown) { return shown.start == start; });
  }
  // Whether people met what looks like it.
  [[nodiscard]] bool is_shown(const Lesson& lesson, StartIndex start) const {
    const auto looks = atlas_.trajectory_class(start);
    return is_shown_[looks] || std::ranges::any_of(lesson.shown, [&](const auto& shown) {
             return atlas_.trajectory_class(shown.start) == looks;
           });
  }

  TeachingCache& cache_;
  const Atlas& atlas_;
  const TeachingView& view_;
  LessonLoss& loss_;
  LessonLimits limits_;
  RandomStream random_;
  ConstraintSet known_;  // minimal, of all that was taught, with the prior
  std::optional<LossOfImitation> imitation_;
  double nothing_ = 0.0;
  std::vector<Candidate> candidates_;
  std::unordered_map<ConstraintSet, std::size_t> by_minimal_;
  std::vector<bool> is_shown_;          // by trajectory class
  std::vector<std::uint64_t> covered_;  // per start; 0 but while starts are looked for
};

}  // namespace

UnitProposal best_lesson(TeachingCache& cache, const TeachingView& view, LessonLoss& loss,
                         std::span<const ImaginedPeople> groups, const LessonLimits& limits, RandomStream random) {
  return LessonSearch{cache, view, loss, groups, limits, random}.best();
}

}  // namespace kith
