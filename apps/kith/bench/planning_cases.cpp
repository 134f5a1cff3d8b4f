// Plans, the atlas that is made of them, and what is looked up there.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "cases.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "kith/teaching/demonstration_selection.hpp"
#include "naive_counterfactuals.hpp"

namespace kith::bench {
namespace {

// Of item delivery with everything on the map; weights that a learner may hold.
Prepared plan_one(Workbench& bench) {
  const auto& domain = bench.atlas().domain();
  const Mdp& mdp = domain.mdp(MdpIndex{domain.num_mdps() - 1});
  static constexpr std::array kWeights{-0.61, 0.55, -0.57};
  Prepared prepared;
  prepared.work = [&mdp](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(behave(mdp, kWeights));
  };
  prepared.rival = [&mdp](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(value_iteration(mdp, kWeights));
  };
  prepared.disagreement = [&mdp]() -> std::string {
    const auto ours = behave(mdp, kWeights);
    const auto theirs = value_iteration(mdp, kWeights);
    if (!ours || !theirs.converged) return "no finite optimum";
    for (std::size_t s = 0; s < ours->values.size(); ++s) {
      if (std::abs(ours->values[s] - theirs.values[s]) > 1e-9)
        return "values of state " + std::to_string(s) + " differ";
    }
    return {};
  };
  return prepared;
}

Prepared build_atlas(Workbench& /*bench*/) {
  Prepared prepared;
  prepared.work = [domain = load_domain("item-delivery")](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(Atlas{domain}.num_demos());
  };
  return prepared;
}

// A team's belief after a first lesson that conveyed the first knowledge component, from which the next lesson
// imagines 8 people.
struct Interaction {
  explicit Interaction(const Atlas& made) : atlas{made}, belief{made.prior_cone(), FilterOptions{}} {
    const auto& component = atlas.knowledge_components().front();
    belief.observe(atlas.constraints().half_spaces(component.constraints), options.likelihood, RandomStream{5});
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> persons(const RandomStream& random) const {
    std::vector<Eigen::Vector3d> points;
    for (const auto& draw : belief.systematic_draws(options.counterfactuals, random))
      points.emplace_back(belief.point(draw.index));
    return points;
  }

  [[nodiscard]] std::vector<PolicyCellIndex> cells(const RandomStream& random) const {
    std::vector<PolicyCellIndex> cells;
    for (const auto& weights : persons(random)) cells.push_back(atlas.cells().locate(weights));
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }

  const Atlas& atlas;
  ParticleBelief belief;
  SelectionOptions options;
};

RandomStream turn(std::uint64_t n) { return RandomStream{6}.split(n); }

// Bit by bit what value iteration finds, for every demonstration of the domain.
std::string conveyed_disagree(const Interaction& interaction, const NaiveCounterfactuals& rival) {
  const auto& atlas = interaction.atlas;
  std::size_t found = 0;
  for (std::uint64_t n = 0; n < 2; ++n) {
    const auto theirs = rival.conveyed(interaction.persons(turn(n)));
    const auto rows = atlas.conveyed_by_class(interaction.cells(turn(n)));
    for (DemoIndex demo{0}; demo.value() < atlas.num_demos(); ++demo) {
      const auto row =
          std::span{rows}.subspan(atlas.demo_class(demo).value() * atlas.words_per_set(), atlas.words_per_set());
      if (atlas.constraints().half_spaces(ConstraintSet{row}) != theirs[demo.value()])
        return "what demonstration " + std::to_string(demo.value()) + " conveys differs";
      found += theirs[demo.value()].size();
    }
  }
  return found > 0 ? "" : "nothing is conveyed at all";
}

Prepared counterfactuals(Workbench& bench) {
  const auto interaction = std::make_shared<const Interaction>(bench.atlas());
  const auto naive = std::make_shared<const NaiveCounterfactuals>(bench.atlas());
  Prepared prepared;
  prepared.work = [=, n = std::uint64_t{0}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds, ++n) keep(interaction->atlas.conveyed_by_class(interaction->cells(turn(n % 64)))[0]);
  };
  prepared.rival = [=, n = std::uint64_t{0}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds, ++n) keep(naive->conveyed(interaction->persons(turn(n % 64))).size());
  };
  prepared.disagreement = [=] { return conveyed_disagree(*interaction, *naive); };
  return prepared;
}

// A bound from below on any rival that plans for each person: what is conveyed is not even collected.
Prepared counterfactuals_and_plans(Workbench& bench) {
  auto prepared = counterfactuals(bench);
  const auto interaction = std::make_shared<const Interaction>(bench.atlas());
  const auto naive = std::make_shared<const NaiveCounterfactuals>(bench.atlas());
  prepared.rival = [=, n = std::uint64_t{0}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds, ++n) keep(naive->plans(interaction->persons(turn(n % 64))));
  };
  return prepared;
}

Prepared counterfactuals_again(Workbench& bench) {
  const auto interaction = std::make_shared<const Interaction>(bench.atlas());
  const auto cache = std::make_shared<TeachingCache>(bench.atlas());
  Prepared prepared;
  const auto& all = interaction->atlas.knowledge_components().back();
  prepared.work = [=, &all, n = std::uint64_t{0}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds, ++n)
      keep(cache->behaviours().conveyed_by_class(all, interaction->cells(turn(n % 64))).rows[0]);
  };
  return prepared;
}

Prepared unit(Workbench& bench) {
  const auto interaction = std::make_shared<const Interaction>(bench.atlas());
  const auto cache = std::make_shared<TeachingCache>(bench.atlas());
  Prepared prepared;
  const auto taught = bench.atlas().constraints().half_spaces(bench.atlas().knowledge_components()[0].constraints);
  prepared.work = [=, n = std::uint64_t{0}](std::size_t rounds) mutable {
    const auto& atlas = interaction->atlas;
    for (; rounds > 0; --rounds, ++n) {
      keep(select_demonstrations(*cache, interaction->belief, atlas.knowledge_components()[1], taught,
                                 VisitedDemos{atlas.num_demos()}, interaction->options, turn(n % 64)));
    }
  };
  return prepared;
}

}  // namespace

void add_planning_cases(std::vector<Case>& cases) {
  cases.push_back({"mdp.plan", "the plan of one MDP of item delivery, 186 states", "value iteration", Clock::kCpu,
                   false, plan_one});
  cases.push_back(
      {"bec.atlas", "the atlas of item delivery: 64 MDPs, 9 312 demonstrations", "", Clock::kCpu, false, build_atlas});
  cases.push_back({"bec.counterfactuals", "what 9 312 demonstrations would convey to 8 people, none met before",
                   "value iteration for each person in each MDP", Clock::kCpu, false, counterfactuals});
  cases.push_back({"bec.counterfactuals-plans", "the same", "value iteration alone, nothing collected", Clock::kCpu,
                   false, counterfactuals_and_plans});
  cases.push_back({"teaching.counterfactuals", "the same with what a thread remembers of people met before", "",
                   Clock::kCpu, false, counterfactuals_again});
  cases.push_back({"teaching.unit", "the choice of a lesson's demonstrations", "", Clock::kCpu, false, unit});
}

}  // namespace kith::bench
