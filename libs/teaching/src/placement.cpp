#include "kith/teaching/placement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "kith/belief/particle_belief.hpp"

namespace kith {
namespace {

constexpr double kNothing = 1e-9;  // bits of information below this are rounding

// One test of a hull: the simplest start, the first of several.
struct HullStart {
  HullIndex hull;
  DemoIndex demo;
};

std::vector<HullStart> starts_of_hulls(const Atlas& atlas) {
  std::map<std::size_t, DemoIndex> simplest;
  const auto complexity = [&](DemoIndex demo) { return atlas.domain().complexity(atlas.id(demo)); };
  for (std::size_t i = 0; i < atlas.num_demos(); ++i) {
    const DemoIndex demo{i};
    if (!atlas.is_candidate(demo) || atlas.tested_constraints(demo).without(atlas.prior()).empty()) continue;
    const auto [entry, is_new] = simplest.try_emplace(atlas.hull(demo).value(), demo);
    if (!is_new && complexity(demo) < complexity(entry->second)) entry->second = demo;
  }
  std::vector<HullStart> starts;
  for (const auto& [hull, demo] : simplest) starts.push_back({HullIndex{hull}, demo});
  return starts;
}

// Mass of every policy cell under every hypothesis before anything was taught, shape [hypotheses][cells].
std::vector<std::vector<double>> masses_before(const Atlas& atlas, const PriorCover& cover, LikelihoodForm form,
                                               std::span<const LearnerHypothesis> hypotheses) {
  const FilterOptions filter{.particles = cover.size(), .process_noise = 0.0, .resample_below = 0.0};
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const Eigen::Vector3d point = cover.point(i);
    cells.push_back(atlas.cells().locate(point).value());
  }
  const auto components = constraints_of_components(atlas);
  std::vector<std::vector<double>> masses;
  for (const auto& hypothesis : hypotheses) {
    ParticleBelief belief{cover, filter};
    belief.observe(known_half_spaces(components, hypothesis.known),
                   HalfSpaceLikelihood{kAbilityOfKnowing, form, belief.dimension()}, RandomStream{0});
    auto& mass = masses.emplace_back(atlas.cells().size(), 0.0);
    for (std::size_t i = 0; i < cells.size(); ++i) mass[cells[i]] += belief.weights()[i];
  }
  return masses;
}

// sum_h p_h sum_a P_h(a) log(P_h(a) / P(a)); shape of answers: [hypotheses][answers].
double information(std::span<const double> probability, const std::vector<std::vector<double>>& answers) {
  double sum = 0.0;
  for (std::size_t a = 0; a < answers.front().size(); ++a) {
    double any = 0.0;
    for (std::size_t h = 0; h < answers.size(); ++h) any += probability[h] * answers[h][a];
    if (!(any > 0.0)) continue;
    for (std::size_t h = 0; h < answers.size(); ++h) {
      if (answers[h][a] > 0.0) sum += probability[h] * answers[h][a] * std::log(answers[h][a] / any);
    }
  }
  return sum;
}

Test test_at(const Atlas& atlas, DemoIndex demo) {
  return {.demo = demo,
          .covered = atlas.constraints().half_spaces(atlas.tested_constraints(demo).without(atlas.prior())),
          .exact = true};
}

// Greedy choice by what the answers say about the hypotheses.
class PlacementChoice {
 public:
  PlacementChoice(const Atlas& atlas, const PriorCover& cover, LikelihoodForm form,
                  std::span<const LearnerHypothesis> hypotheses)
      : atlas_{atlas},
        starts_{starts_of_hulls(atlas)},
        masses_{masses_before(atlas, cover, form, hypotheses)},
        answers_so_far_(atlas.cells().size(), 0) {
    double sum = 0.0;
    for (const auto& one : hypotheses) sum += one.probability;
    for (const auto& one : hypotheses) probability_.push_back(one.probability / sum);
  }

  std::vector<Test> choose(std::size_t n) {
    std::vector<Test> tests;
    double reached = 0.0;
    while (tests.size() < n) {
      std::optional<HullStart> best;
      double most = reached + kNothing;
      for (const auto& start : starts_) {
        const double with = information(probability_, joint_answers(start.hull));
        if (with > most + kNothing) {
          most = with;
          best = start;
        }
      }
      if (!best) break;
      reached = most;
      tests.push_back(test_at(atlas_, best->demo));
      refine(best->hull);
    }
    return tests;
  }

 private:
  // What people of a cell answer to all tests so far and to this one, as a number.
  [[nodiscard]] std::size_t answer(std::size_t cell, HullIndex hull) const {
    const auto choices = atlas_.hull(hull).losses.size() + 1;
    const auto choice = atlas_.cells().choice(PolicyCellIndex{cell}, hull);
    return answers_so_far_[cell] * choices + (choice == PolicyCells::kNone ? choices - 1 : choice);
  }

  [[nodiscard]] std::vector<std::vector<double>> joint_answers(HullIndex hull) const {
    std::vector<std::vector<double>> answers(masses_.size());
    for (auto& one : answers) one.assign(num_answers_ * (atlas_.hull(hull).losses.size() + 1), 0.0);
    for (std::size_t cell = 0; cell < answers_so_far_.size(); ++cell) {
      const auto a = answer(cell, hull);
      for (std::size_t h = 0; h < masses_.size(); ++h) answers[h][a] += masses_[h][cell];
    }
    return answers;
  }

  void refine(HullIndex hull) {
    std::map<std::size_t, std::size_t> numbers;
    for (std::size_t cell = 0; cell < answers_so_far_.size(); ++cell) {
      answers_so_far_[cell] = numbers.try_emplace(answer(cell, hull), numbers.size()).first->second;
    }
    num_answers_ = numbers.size();
  }

  const Atlas& atlas_;
  std::vector<HullStart> starts_;
  std::vector<std::vector<double>> masses_;
  std::vector<double> probability_;
  std::vector<std::size_t> answers_so_far_;  // of the people of every cell, numbered
  std::size_t num_answers_ = 1;
};

std::vector<Test> tests_of_components(const Atlas& atlas, std::size_t n) {
  std::vector<Test> tests;
  const auto is_new = [&](DemoIndex demo) {
    return std::none_of(tests.begin(), tests.end(), [&](const Test& test) { return test.demo == demo; });
  };
  for (std::size_t round = 0;; ++round) {
    bool any = false;
    for (const auto& component : atlas.knowledge_components()) {
      const auto constraints = component.constraints.without(atlas.prior()).members();
      if (round >= constraints.size()) continue;
      any = true;
      const auto candidates = atlas.tests_for(constraints[round]);
      const auto first = std::find_if(candidates.begin(), candidates.end(), is_new);
      if (first == candidates.end()) continue;
      if (tests.size() == n) return tests;
      tests.push_back(test_at(atlas, *first));
    }
    if (!any) return tests;
  }
}

}  // namespace

std::vector<std::vector<HalfSpace>> constraints_of_components(const Atlas& atlas) {
  std::vector<std::vector<HalfSpace>> components;
  for (const auto& component : atlas.knowledge_components()) {
    components.push_back(atlas.constraints().half_spaces(component.constraints.without(atlas.prior())));
  }
  return components;
}

std::vector<HalfSpace> known_half_spaces(std::span<const std::vector<HalfSpace>> components, std::uint32_t known) {
  std::vector<HalfSpace> all;
  for (std::size_t k = 0; k < components.size(); ++k) {
    if ((known >> k & 1u) == 0u) continue;
    for (const auto& half_space : components[k]) {
      if (std::find(all.begin(), all.end(), half_space) == all.end()) all.push_back(half_space);
    }
  }
  return all;
}

std::vector<Test> placement_tests(const Atlas& atlas, const PriorCover& cover, LikelihoodForm likelihood,
                                  std::span<const LearnerHypothesis> hypotheses, std::size_t n) {
  if (!atlas.is_tabulated()) return tests_of_components(atlas, n);
  return PlacementChoice{atlas, cover, likelihood, hypotheses}.choose(n);
}

}  // namespace kith
