#include "kith/explain/curriculum.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/judgement.hpp"
#include "kith/explain/words.hpp"
#include "kith/geometry/cover.hpp"
#include "kith/teaching/older_robot.hpp"

namespace kith {
namespace {

bool implied_by(const std::vector<HalfSpace>& known, const std::vector<HalfSpace>& constraints) {
  if (known.empty()) return constraints.empty();
  const auto region = Cone::intersection(known);
  return region && std::all_of(constraints.begin(), constraints.end(),
                               [&](const HalfSpace& constraint) { return region->implies(constraint); });
}

Error nothing_to_teach(const Atlas& atlas, const std::string& why) {
  Diagnostic diagnostic;
  diagnostic.id = "E1101";
  diagnostic.message = "nothing about '" + atlas.domain().id() + "' can be taught: " + why;
  diagnostic.hint = "add worlds in which other weights would lead to another path";
  diagnostic.infeasible = true;
  return Error{ErrorKind::kInfeasible, diagnostic.message, {diagnostic}};
}

constexpr const char* kUntold = "no demonstration tells people anything that they do not know beforehand";
constexpr std::size_t kMostPlannedBeliefs = 200;

std::vector<HalfSpace> together(std::vector<HalfSpace> a, const std::vector<HalfSpace>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<HalfSpace> without(std::vector<HalfSpace> all, const std::vector<HalfSpace>& known) {
  std::erase_if(all, [&](const HalfSpace& c) { return std::find(known.begin(), known.end(), c) != known.end(); });
  return all;
}

// Names of the features in `which`, joined by '+', as components are called.
std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts;
  std::istringstream in{name};
  for (std::string part; std::getline(in, part, '+');) parts.push_back(part);
  return parts;
}

// Goes through the lessons of one person and describes each.
class CurriculumMaker {
 public:
  CurriculumMaker(const Atlas& atlas, const CurriculumOptions& options)
      : atlas_{atlas}, options_{options}, cache_{atlas} {
    if (options.beliefs == 0) throw std::invalid_argument{"make_curriculum: there must be at least one belief"};
    if (!older_) return;
    update_ = update_of(atlas, *older_);
    curriculum_.update = update_in_words(atlas, *older_);
    known_ = together(std::move(known_), update_.still);
  }

  Curriculum make() {
    if (older_ && update_.now.empty()) return std::move(curriculum_);
    const RandomStream root{options_.seed};
    auto teaching = options_.teaching;
    teaching.avoids_shortest = true;
    Session session{cache_, teaching, strategy_named(kBaseline), {root.split("person")}, root.split("teacher")};
    std::size_t next = 0;
    while (session.propose(cache_)) {
      const auto lesson = session.lesson();
      for (; next < lesson.component; ++next) skip(next);
      const auto before = together(session.taught_region(), update_.still);
      if (curriculum_.components.empty() || curriculum_.components.back().component != lesson.component) {
        curriculum_.components.push_back(component(lesson, before));
        if (curriculum_.components.back().demonstrations.empty()) {
          curriculum_.components.pop_back();
          skip(lesson.component);
        }
      }
      next = lesson.component + 1;
      known_ = together(before, lesson.taught);
      answer_right(session, lesson.tests);
    }
    for (; next < atlas_.knowledge_components().size(); ++next) skip(next);
    if (curriculum_.components.empty()) {
      require_something_to_teach(atlas_);
      throw nothing_to_teach(atlas_, kUntold);
    }
    keep_what_was_shown();
    choose_first();
    add_brackets();
    add_fresh_tests();
    curriculum_.endless = simplest_endless();
    return std::move(curriculum_);
  }

 private:
  void answer_right(Session& session, const std::vector<Test>& tests) const {
    std::vector<Answer> answers;
    answers.reserve(tests.size());
    for (const auto& test : tests) answers.emplace_back(atlas_.feature_counts(test.start));
    const std::vector<std::vector<Answer>> all{answers};
    static_cast<void>(session.submit(all));
  }

  CurriculumComponent component(const Lesson& lesson, const std::vector<HalfSpace>& before) {
    const auto& taught = atlas_.knowledge_components()[lesson.component];
    CurriculumComponent result;
    result.component = lesson.component;
    result.name = component_in_words(atlas_, lesson.component);
    result.constraints = news(without(atlas_.constraints().half_spaces(taught.constraints), atlas_.domain().prior()));
    result.area_sr = taught.area_sr;
    auto known = before;
    for (const auto& shown : lesson.demonstrations) {
      if (news(shown.half_spaces).empty()) continue;
      result.demonstrations.push_back(demonstration(shown, known));
      known = together(known, shown.half_spaces);
    }
    const auto points = beliefs(older_ ? older_->minimal_set() : before);
    for (const auto& test : lesson.tests) {
      if (!news(test.covered).empty()) result.tests.push_back(graded(test, points));
    }
    std::stable_sort(result.tests.begin(), result.tests.end(),
                     [](const CurriculumTest& a, const CurriculumTest& b) { return a.share_right > b.share_right; });
    return result;
  }

  CurriculumDemonstration demonstration(const Demonstration& shown, const std::vector<HalfSpace>& known) {
    auto conveys = news(without(shown.half_spaces, atlas_.domain().prior()));
    KITH_ASSERT(!conveys.empty());  // else it would have had no gain
    const auto main = most_telling(conveys, known);
    auto contrast = contrast_for(cache_.behaviours(), shown.start, main, cells_of(shown.counterfactuals));
    KITH_ASSERT(contrast.has_value());  // what is conveyed is a comparison with an expected path
    auto sentence = reason(atlas_, *contrast, conveys);
    return {shown.start, std::move(conveys), main, *std::move(contrast), std::move(sentence), runs_from(shown.start)};
  }

  // What people do not know of the robot as it was before.
  [[nodiscard]] std::vector<HalfSpace> news(std::vector<HalfSpace> constraints) const {
    if (older_) std::erase_if(constraints, [&](const HalfSpace& c) { return older_->implies(c); });
    return constraints;
  }

  [[nodiscard]] std::vector<PolicyRun> runs_from(StartIndex start) const {
    auto random = RandomStream{options_.seed}.split("runs").split(start.value());
    return several_runs(atlas_, start, options_.runs, random);
  }

  // In the order of the tables, where there are some.
  [[nodiscard]] std::vector<PolicyCellIndex> cells_of(const std::vector<Direction>& weights) {
    std::vector<PolicyCellIndex> cells;
    cells.reserve(weights.size());
    for (const auto& w : weights) cells.push_back(cache_.behaviours().locate(w));
    if (atlas_.find_tables()) std::sort(cells.begin(), cells.end());
    return cells;
  }

  // The constraint that leaves the least of what was known before; among equals the first.
  [[nodiscard]] static HalfSpace most_telling(const std::vector<HalfSpace>& conveys,
                                              const std::vector<HalfSpace>& known) {
    const auto left = [&](const HalfSpace& c) { return solid_angle(together(known, {c})); };
    return *std::min_element(conveys.begin(), conveys.end(), [&](const HalfSpace& a, const HalfSpace& b) {
      constexpr double kTolerance = 1e-9;
      return left(a) < left(b) - kTolerance;
    });
  }

  // Policy cells of beliefs that fill what was known before evenly.
  [[nodiscard]] std::vector<PolicyCellIndex> beliefs(const std::vector<HalfSpace>& before) {
    Cone region{atlas_.domain().num_features()};
    const bool has_interior = region.clip(before);
    KITH_ASSERT(has_interior);  // the robot's weights are inside
    // Where each of them has to be planned, fewer.
    const auto n = atlas_.find_tables() ? options_.beliefs : std::min(options_.beliefs, kMostPlannedBeliefs);
    const Eigen::MatrixXd points = cover(region, n, atlas_.feature_order());
    std::vector<PolicyCellIndex> cells;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      cells.push_back(cache_.behaviours().locate(Direction{points.col(i)}));
    }
    return cells;
  }

  [[nodiscard]] CurriculumTest graded(const Test& test, const std::vector<PolicyCellIndex>& points) {
    constexpr double kEasy = 2.0 / 3.0;
    constexpr double kHard = 1.0 / 3.0;
    const auto right = std::count_if(points.begin(), points.end(), [&](PolicyCellIndex cell) {
      const auto answer = cache_.behaviours().answer(test.start, cell);
      return answer && judge_path(atlas_.domain(), atlas_.feature_counts(test.start), *answer).is_right;
    });
    const auto share = static_cast<double>(right) / static_cast<double>(points.size());
    const auto difficulty = share >= kEasy  ? Difficulty::kEasy
                            : share < kHard ? Difficulty::kHard
                                            : Difficulty::kMedium;
    return {test.start, test.covered, test.is_shortest_wrong, false, share, difficulty, runs_from(test.start)};
  }

  // Of some starts in worlds that were neither shown nor tested, those about which most can be wrong; each in a world
  // of its own.
  void add_fresh_tests() {
    constexpr std::size_t kTried = 60, kTriedWithoutTables = 6;
    std::vector<bool> is_seen(atlas_.domain().num_mdps(), false);
    for (const auto& component : curriculum_.components) {
      for (const auto& shown : component.demonstrations) is_seen[atlas_.id(shown.start).mdp.value()] = true;
      for (const auto& test : component.tests) is_seen[atlas_.id(test.start).mdp.value()] = true;
    }

    std::vector<StartIndex> starts;
    for (StartIndex start{0}; start.value() < atlas_.num_states(); ++start) {
      if (atlas_.is_candidate(start) && !is_seen[atlas_.id(start).mdp.value()]) starts.push_back(start);
    }

    auto random = RandomStream{options_.seed}.split("fresh");
    const auto n = std::min(starts.size(), atlas_.find_tables() ? kTried : kTriedWithoutTables);
    for (std::size_t i = 0; i < n; ++i) std::swap(starts[i], starts[i + uniform_index(starts.size() - i, random)]);
    const auto points = beliefs(older_ ? older_->minimal_set() : atlas_.domain().prior());

    // The best tests are those that half of the people would answer rightly.
    std::vector<CurriculumTest> tried;
    for (std::size_t i = 0; i < n; ++i) tried.push_back(graded({starts[i], {}}, points));
    std::ranges::stable_sort(tried, {}, [](const CurriculumTest& test) { return std::abs(test.share_right - 0.5); });

    for (auto& test : tried) {
      const auto world = atlas_.id(test.start).mdp.value();
      if (curriculum_.fresh.size() == options_.fresh || is_seen[world] || test.share_right == 1.0) continue;
      is_seen[world] = true;
      curriculum_.fresh.push_back(std::move(test));
    }
  }

  // Of what the components are about; of some there may be nothing left that could be shown.
  void keep_what_was_shown() {
    Cone shown = atlas_.prior_cone();
    const bool is_possible = shown.clip(update_.still);
    KITH_ASSERT(is_possible);  // the robot's weights lie inside
    for (const auto& component : curriculum_.components) {
      for (const auto& one : component.demonstrations) {
        const bool has_room = shown.clip(one.conveys);
        KITH_ASSERT(has_room);  // the robot's weights lie inside
      }
    }
    for (auto& component : curriculum_.components) {
      std::erase_if(component.constraints, [&](const HalfSpace& constraint) { return !shown.implies(constraint); });
    }
  }

  // Each start once; of every component what comes first.
  void choose_first() {
    std::set<StartIndex> seen;
    std::vector<std::pair<double, bool*>> boards;  // by how late they come in their component
    const auto add = [&](double rank, StartIndex start, bool& is_first) {
      if (seen.insert(start).second) boards.emplace_back(rank, &is_first);
    };
    for (auto& component : curriculum_.components) {
      for (std::size_t i = 0; auto& shown : component.demonstrations) {
        add(static_cast<double>(i++), shown.start, shown.is_first);
      }
      for (std::size_t i = 0; auto& test : component.tests) {
        const auto rank = static_cast<double>(i++) + 0.5;
        if (test.is_shortest_wrong) add(rank, test.start, test.is_first);
      }
    }
    std::ranges::stable_sort(boards, {}, &std::pair<double, bool*>::first);
    for (std::size_t i = 0; i < std::min(boards.size(), Curriculum::kMostFirst); ++i) *boards[i].second = true;
  }

  void add_brackets() {
    auto known = together(atlas_.domain().prior(), update_.still);
    for (const bool is_first : {true, false}) {
      for (auto& component : curriculum_.components) {
        const auto& features = atlas_.knowledge_components()[component.component].features;
        for (auto& shown : component.demonstrations) {
          if (shown.is_first != is_first) continue;
          known = together(std::move(known), shown.conveys);
          shown.brackets = brackets(atlas_.domain(), known, features, reference_);
        }
      }
    }
  }

  [[nodiscard]] std::optional<StartIndex> simplest_endless() const {
    std::optional<StartIndex> simplest;
    for (StartIndex start{0}; start.value() < atlas_.num_states(); ++start) {
      const auto& mdp = atlas_.domain().mdp(atlas_.id(start).mdp);
      if (!atlas_.is_candidate(start) || !mdp.is_deterministic() || mdp.discount() == 1.0) continue;
      if (simplest && atlas_.complexity(*simplest) <= atlas_.complexity(start)) continue;
      if (atlas_.trajectory(start).repeats_from) simplest = start;
    }
    return simplest;
  }

  void skip(std::size_t component) {
    curriculum_.skipped.push_back({component_in_words(atlas_, component), why_skipped(component)});
  }

  [[nodiscard]] std::string why_skipped(std::size_t component) const {
    const auto& skipped = atlas_.knowledge_components()[component];
    const bool has_worlds = std::find(skipped.uses_mdp.begin(), skipped.uses_mdp.end(), true) != skipped.uses_mdp.end();
    if (!has_worlds) return "no world has only the features that it weighs";
    const auto constraints = atlas_.constraints().half_spaces(skipped.constraints);
    if (older_ && news(constraints).empty()) return "it is as before the update";
    if (implied_by(atlas_.domain().prior(), constraints)) return "everybody knows it beforehand";
    if (implied_by(known_, constraints)) return "already implied by earlier parts";
    return "no further demonstration adds to the earlier ones";
  }

  const Atlas& atlas_;
  const CurriculumOptions& options_;
  TeachingCache cache_;
  const std::optional<Cone>& older_ = options_.teaching.known;
  RobotUpdate update_;
  Curriculum curriculum_;
  std::vector<HalfSpace> known_ = atlas_.domain().prior();
  std::size_t reference_ = reference_feature(atlas_.domain(), atlas_.knowledge_components());
};

}  // namespace

void require_something_to_teach(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  if (implied_by(domain.prior(), atlas.policy_bec_half_spaces())) {
    std::vector<std::string> known;
    for (const auto& half_space : domain.prior()) known.push_back(in_words(domain, half_space));
    throw nothing_to_teach(atlas, known.empty() ? "the robot does the same with any reward"
                                                : "anybody who knows beforehand that " + listed(known) +
                                                      " predicts everything that the robot does");
  }
  if (const auto* tables = atlas.find_tables(); tables && tables->coverage().max == 1) {
    throw nothing_to_teach(atlas, "in every world, everybody who expects the robot to finish predicts the same path");
  }
  TeachingCache cache{atlas};
  const VisitedStarts nothing{atlas.num_states()};
  for (const auto& component : atlas.knowledge_components()) {
    Unit unit{{}, domain.prior()};
    complete_unit(cache, unit, component, {}, nothing, {.max_demonstrations = 1}, RandomStream{0});
    if (!unit.demonstrations.empty()) return;
  }
  throw nothing_to_teach(atlas, kUntold);
}

const char* name_of(Difficulty difficulty) noexcept {
  switch (difficulty) {
    case Difficulty::kEasy:
      return "easy";
    case Difficulty::kMedium:
      return "medium";
    case Difficulty::kHard:
      return "hard";
  }
  return "";
}

std::string component_in_words(const Atlas& atlas, std::size_t component) {
  const auto& domain = atlas.domain();
  const auto& components = atlas.knowledge_components();
  const auto& names = domain.feature_names();
  const auto weighed = [&](std::size_t c) { return parts_of(components.at(c).name); };
  const auto all = weighed(components.size() - 1);  // the last component weighs all features
  std::vector<std::string> things;
  std::string reference;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto parts = weighed(component);
    const auto words = in_general(domain.wording(k));
    if (std::find(parts.begin(), parts.end(), names[k]) != parts.end()) things.push_back(words);
    if (std::find(all.begin(), all.end(), names[k]) == all.end()) reference = words;
  }
  return listed(things) + " versus " + reference;
}

Curriculum make_curriculum(const Atlas& atlas, const CurriculumOptions& options) {
  return CurriculumMaker{atlas, options}.make();
}

}  // namespace kith
