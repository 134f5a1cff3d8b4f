#include "kith/teaching/test_selection.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "test_order.hpp"

namespace kith {
namespace {

// The start states that can test one taught constraint.
struct Candidates {
  HalfSpace constraint;
  std::vector<StartIndex> demos;  // ascending
  bool exact = true;
};

bool same_features(const HalfSpace& a, const HalfSpace& b) {
  for (std::size_t k = 0; k < a.normal().size(); ++k) {
    if ((a.normal()[k] == 0) != (b.normal()[k] == 0)) return false;
  }
  return true;
}

double cosine(const HalfSpace& a, const HalfSpace& b) {
  if (a.dimension() == 3) return a.unit_normal().dot(b.unit_normal());
  return a.unit().dot(b.unit());
}

class TestSelection {
 public:
  TestSelection(const Atlas& atlas, const KnowledgeComponent& component, const std::vector<Demonstration>& unit,
                VisitedStarts& visited, const RandomStream& random, const TestPreferences* preferences)
      : atlas_{atlas},
        component_{component},
        unit_{unit},
        visited_{visited},
        random_{random},
        preferences_{preferences},
        is_shown_(atlas.num_states(), false) {
    for (const auto start : visited.in_order()) is_shown_[atlas.trajectory_class(start)] = true;
  }

  TestChoice choose(const std::vector<HalfSpace>& taught) {
    TestChoice choice;
    std::vector<Candidates> open;
    for (const auto& constraint : taught) {
      if (auto candidates = candidates_for(constraint)) {
        open.push_back(std::move(*candidates));
      } else {
        ++choice.untested;
      }
    }
    if (open.size() > 1) num_tested_.assign(atlas_.num_states(), 0);
    while (open.size() > 1) {
      auto test = covering_several(open);
      if (!test) break;
      choice.tests.push_back(std::move(*test));
    }
    for (auto one = open.rbegin(); one != open.rend(); ++one) choice.tests.push_back(covering_one(*one, taught));
    for (const auto& test : choice.tests) visited_.insert(test.start);
    return choice;
  }

 private:
  // Those that test `constraint`, new ones if there are any; else those of the nearest constraint.
  [[nodiscard]] std::optional<Candidates> candidates_for(const HalfSpace& constraint) const {
    const auto own = atlas_.constraints().find(constraint);
    if (own) {
      if (auto demos = usable(*own); !demos.empty()) return Candidates{constraint, std::move(demos), true};
    }
    const auto nearest = nearest_testable(constraint);
    if (!nearest) return std::nullopt;
    return Candidates{constraint, usable(*nearest), false};
  }

  // The constraint most like `constraint` that some start of the component tests: first those over the same features,
  // then the smallest angle, then the first.
  [[nodiscard]] std::optional<ConstraintIndex> nearest_testable(const HalfSpace& constraint) const {
    std::optional<ConstraintIndex> nearest;
    std::pair<bool, double> least;
    for (ConstraintIndex c{0}; c.value() < atlas_.constraints().size(); ++c) {
      const auto& other = atlas_.constraints()[c];
      const std::pair rank{!same_features(other, constraint), -cosine(other, constraint)};
      if (nearest && !(rank < least)) continue;
      const auto demos = atlas_.tests_for(c);
      if (std::none_of(demos.begin(), demos.end(), [&](StartIndex start) { return is_in_component(start); })) continue;
      nearest = c;
      least = rank;
    }
    return nearest;
  }

  [[nodiscard]] bool is_in_component(StartIndex start) const {
    return component_.uses_mdp[atlas_.id(start).mdp.value()];
  }

  [[nodiscard]] std::vector<StartIndex> usable(ConstraintIndex c) const {
    std::vector<StartIndex> found;
    auto least = Met::kDemonstrated;
    for (const auto start : atlas_.tests_for(c)) {
      if (!is_in_component(start)) continue;
      const auto met = how_met(start);
      if (met > least) continue;
      if (met < least) found.clear();
      least = met;
      found.push_back(start);
    }
    return found;
  }

  // How people met what they are to be asked about: the less the better.
  enum class Met { kNever, kPicture, kTested, kDemonstrated };
  [[nodiscard]] Met how_met(StartIndex start) const {
    if (!is_shown_[atlas_.trajectory_class(start)]) return Met::kNever;
    if (preferences_ == nullptr || preferences_->demonstrated.contains(start)) return Met::kDemonstrated;
    return visited_.contains(start) ? Met::kTested : Met::kPicture;
  }

  // The start that tests most of the open constraints, if it tests at least two; they are closed.
  std::optional<Test> covering_several(std::vector<Candidates>& open) {
    std::uint32_t most = 2;
    for (const auto& candidates : open) {
      for (const auto start : candidates.demos) most = std::max(most, ++num_tested_[start.value()]);
    }
    std::vector<StartIndex> best;
    for (const auto& candidates : open) {
      for (const auto start : candidates.demos) {
        if (num_tested_[start.value()] == most) best.push_back(start);
        num_tested_[start.value()] = 0;
      }
    }
    if (best.empty()) return std::nullopt;
    std::sort(best.begin(), best.end());
    Test test;
    test.start = most_complex(best);
    std::erase_if(open, [&](const Candidates& candidates) {
      if (!std::binary_search(candidates.demos.begin(), candidates.demos.end(), test.start)) return false;
      test.covered.push_back(candidates.constraint);
      test.exact = test.exact && candidates.exact;
      return true;
    });
    return test;
  }

  // A start for one constraint covers, in its feedback, all taught ones that its path shows.
  Test covering_one(const Candidates& candidates, const std::vector<HalfSpace>& taught) {
    Test test;
    test.start = most_complex(candidates.demos);
    test.exact = candidates.exact;
    const auto& shown = atlas_.one_step(test.start);
    for (const auto& constraint : taught) {
      const auto c = atlas_.constraints().find(constraint);
      if (constraint == candidates.constraint || (c && shown.contains(*c))) test.covered.push_back(constraint);
    }
    return test;
  }

  [[nodiscard]] StartIndex most_complex(const std::vector<StartIndex>& starts) const {
    return test_to_ask(atlas_, starts, unit_, random_, preferences_);
  }

  const Atlas& atlas_;
  const KnowledgeComponent& component_;
  const std::vector<Demonstration>& unit_;
  VisitedStarts& visited_;
  const RandomStream& random_;
  const TestPreferences* preferences_;
  std::vector<bool> is_shown_;             // by trajectory class, of which there are no more than demonstrations
  std::vector<std::uint32_t> num_tested_;  // per start, of the open constraints; 0 but in covering_several()
};

}  // namespace

TestChoice select_tests(const Atlas& atlas, const KnowledgeComponent& component, const std::vector<Demonstration>& unit,
                        const std::vector<HalfSpace>& taught, VisitedStarts& visited, RandomStream random,
                        const TestPreferences* preferences) {
  return TestSelection{atlas, component, unit, visited, random, preferences}.choose(taught);
}

}  // namespace kith
