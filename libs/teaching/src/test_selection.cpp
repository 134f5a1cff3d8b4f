#include "kith/teaching/test_selection.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <unordered_set>

#include "visual_order.hpp"

namespace kith {
namespace {

// The start states that can test one taught constraint.
struct Candidates {
  HalfSpace constraint;
  std::vector<DemoIndex> demos;  // ascending
  bool exact = true;
};

bool same_features(const HalfSpace& a, const HalfSpace& b) {
  for (std::size_t k = 0; k < a.normal().size(); ++k) {
    if ((a.normal()[k] == 0) != (b.normal()[k] == 0)) return false;
  }
  return true;
}

class TestSelection {
 public:
  TestSelection(const Atlas& atlas, const KnowledgeComponent& component, const std::vector<Demonstration>& unit,
                std::vector<bool>& visited, const RandomStream& random)
      : atlas_{atlas}, component_{component}, unit_{unit}, visited_{visited}, random_{random} {
    for (std::size_t i = 0; i < visited.size(); ++i) {
      if (visited[i]) shown_classes_.insert(atlas.trajectory_class(DemoIndex{i}));
    }
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
    while (auto test = covering_several(open)) choice.tests.push_back(std::move(*test));
    for (auto one = open.rbegin(); one != open.rend(); ++one) choice.tests.push_back(covering_one(*one, taught));
    for (const auto& test : choice.tests) visited_[test.demo.value()] = true;
    return choice;
  }

 private:
  // Those that test `constraint`, new ones if there are any; else those of the nearest constraint.
  [[nodiscard]] std::optional<Candidates> candidates_for(const HalfSpace& constraint) const {
    const auto own = atlas_.constraints().find(constraint);
    if (own) {
      if (auto demos = usable(*own); !demos.empty()) return Candidates{constraint, std::move(demos), true};
    }
    std::vector<std::size_t> others(atlas_.constraints().size());
    std::iota(others.begin(), others.end(), std::size_t{0});
    const auto rank = [&](std::size_t c) {
      const auto& other = atlas_.constraints()[ConstraintIndex{c}];
      return std::pair{same_features(other, constraint) ? 0 : 1, -other.unit_normal().dot(constraint.unit_normal())};
    };
    std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    for (const auto c : others) {
      if (auto demos = usable(ConstraintIndex{c}); !demos.empty())
        return Candidates{constraint, std::move(demos), false};
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<DemoIndex> usable(ConstraintIndex c) const {
    std::vector<DemoIndex> all;
    std::vector<DemoIndex> fresh;
    for (const auto demo : atlas_.tests_for(c)) {
      if (!component_.uses_mdp[atlas_.id(demo).mdp.value()]) continue;
      all.push_back(demo);
      if (!visited_[demo.value()] && !shown_classes_.contains(atlas_.trajectory_class(demo))) fresh.push_back(demo);
    }
    return fresh.empty() ? all : fresh;
  }

  // The start that tests most of the open constraints, if it tests at least two; they are closed.
  std::optional<Test> covering_several(std::vector<Candidates>& open) {
    std::vector<DemoIndex> all;
    for (const auto& candidates : open) all.insert(all.end(), candidates.demos.begin(), candidates.demos.end());
    std::sort(all.begin(), all.end());
    std::size_t most = 1;
    std::vector<DemoIndex> best;
    for (auto run = all.begin(); run != all.end();) {
      const auto end = std::find_if(run, all.end(), [&](DemoIndex d) { return d != *run; });
      const auto count = static_cast<std::size_t>(end - run);
      if (count > most) best.clear();
      if (count >= std::max<std::size_t>(most, 2)) best.push_back(*run);
      most = std::max(most, count);
      run = end;
    }
    if (best.empty()) return std::nullopt;
    Test test;
    test.demo = most_complex(best);
    std::erase_if(open, [&](const Candidates& candidates) {
      if (!std::binary_search(candidates.demos.begin(), candidates.demos.end(), test.demo)) return false;
      test.covered.push_back(candidates.constraint);
      test.exact = test.exact && candidates.exact;
      return true;
    });
    return test;
  }

  // A start for one constraint covers, in its feedback, all taught ones that its path shows.
  Test covering_one(const Candidates& candidates, const std::vector<HalfSpace>& taught) {
    Test test;
    test.demo = most_complex(candidates.demos);
    test.exact = candidates.exact;
    const auto& shown = atlas_.one_step(test.demo);
    for (const auto& constraint : taught) {
      const auto c = atlas_.constraints().find(constraint);
      if (constraint == candidates.constraint || (c && shown.contains(*c))) test.covered.push_back(constraint);
    }
    return test;
  }

  // Most complex, then least like the unit's demonstrations on average, then chance.
  [[nodiscard]] DemoIndex most_complex(const std::vector<DemoIndex>& demos) const {
    DemoIndex best;
    std::optional<VisualKey> best_key;
    for (const auto demo : demos) {
      const auto id = atlas_.id(demo);
      std::int64_t difference = 0;
      for (const auto& shown : unit_) difference += atlas_.domain().dissimilarity(id, atlas_.id(shown.demo));
      VisualKey key{-atlas_.domain().complexity(id), -difference, 0};
      if (best_key && key > *best_key) continue;
      key.chance = chance_of(demo, random_);
      if (best_key && key >= *best_key) continue;
      best_key = key;
      best = demo;
    }
    return best;
  }

  const Atlas& atlas_;
  const KnowledgeComponent& component_;
  const std::vector<Demonstration>& unit_;
  std::vector<bool>& visited_;
  const RandomStream& random_;
  std::unordered_set<std::uint32_t> shown_classes_;
};

}  // namespace

TestChoice select_tests(const Atlas& atlas, const KnowledgeComponent& component, const std::vector<Demonstration>& unit,
                        const std::vector<HalfSpace>& taught, std::vector<bool>& visited, RandomStream random) {
  return TestSelection{atlas, component, unit, visited, random}.choose(taught);
}

}  // namespace kith
