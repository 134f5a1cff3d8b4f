#include "kith/bec/inference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "item_delivery.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/policy_file.hpp"
#include "kith/domains/variation.hpp"
#include "kith/mdp/behaviour.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// What somebody with these weights does in every state.
ObservedPolicy policy_under(const Domain& domain, const std::vector<double>& weights) {
  ObservedPolicy policy;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const Mdp& mdp = domain.mdp(m);
    const auto behaviour = behave(mdp, weights);
    auto& probability = policy.probability.emplace_back(mdp.num_choices(), 0.0);
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s)
      probability[mdp.first_choice(s) + behaviour->choice[s.value()]] = 1.0;
    policy.is_seen.emplace_back(mdp.num_states(), true);
  }
  return policy;
}

void take(ObservedPolicy& policy, const Mdp& mdp, std::size_t m, StateIndex s, std::size_t choice) {
  for (std::size_t c = 0; c < mdp.choices(s).size(); ++c)
    policy.probability[m][mdp.first_choice(s) + c] = c == choice ? 1.0 : 0.0;
}

std::size_t choice_of(const ObservedPolicy& policy, const Mdp& mdp, std::size_t m, StateIndex s) {
  const auto first = policy.probability[m].begin() + static_cast<std::ptrdiff_t>(mdp.first_choice(s));
  return static_cast<std::size_t>(std::max_element(first, first + static_cast<std::ptrdiff_t>(mdp.choices(s).size())) -
                                  first);
}

ObservedPolicy robots(const Atlas& atlas) {
  const Domain& domain = atlas.domain();
  ObservedPolicy policy;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const Mdp& mdp = domain.mdp(m);
    auto& probability = policy.probability.emplace_back(mdp.num_choices(), 0.0);
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
      const auto choices = mdp.choices(s);
      for (std::size_t c = 0; c < choices.size(); ++c) {
        if (choices[c].action == atlas.action(atlas.index({m, s}))) probability[mdp.first_choice(s) + c] = 1.0;
      }
    }
    policy.is_seen.emplace_back(mdp.num_states(), true);
  }
  return policy;
}

std::string grid_text(RandomStream& random, const std::string& discount) {
  std::string rows;
  for (int y = 0; y < 5; ++y) {
    std::string row;
    for (int x = 0; x < 5; ++x) row += "..wwm"[uniform_index(5, random)];
    if (y == 0) row[0] = 'S';
    if (y == 4) row[4] = 'H';
    rows += "\"" + row + "\", ";
  }
  return "schema = \"kith.domain/1\"\nid = \"grid\"\n[mdp]\ndiscount = " + discount + "\n[map]\nrows = [" + rows +
         "]\n[map.legend]\n\".\" = \"floor\"\n\"w\" = { terrain = \"wet\" }\n\"m\" = { terrain = \"mud\" }\n"
         "\"S\" = { start = true }\n\"H\" = { goal = true }\n"
         "[[feature]]\nname = \"wet\"\nwhen = \"enter:wet\"\n[[feature]]\nname = \"mud\"\nwhen = \"enter:mud\"\n"
         "[[feature]]\nname = \"step\"\nwhen = \"action\"\n[prior]\nhalfspaces = [ { step = -1 } ]\n";
}

Domain grid(RandomStream& random) {
  auto reading = parse_unweighed_domain(grid_text(random, "1.0"), "grid");
  EXPECT_TRUE(reading.domain) << (reading.diagnostics.empty() ? "" : reading.diagnostics.front().message);
  return *reading.domain;
}

std::vector<double> random_costs(RandomStream& random) {
  return {-0.1 - 3.0 * uniform01(random), -0.1 - 3.0 * uniform01(random), -1.0};
}

TEST(Inference, GivesBackTheRegionOfItemDelivery) {
  const auto& atlas = item_delivery();
  const auto found = infer_weights(atlas.domain(), robots(atlas));
  Cone region = atlas.prior_cone();
  ASSERT_TRUE(region.clip(atlas.policy_bec_half_spaces()));
  EXPECT_EQ(found.region, region);
  EXPECT_TRUE(found.is_optimal);
  EXPECT_DOUBLE_EQ(found.share, 1.0);
  EXPECT_TRUE(found.left_out.empty());
  EXPECT_GT(found.margin, 0.0);
}

TEST(Inference, FindsARegionThatHoldsTheWeightsOfRandomRobots) {
  RandomStream random{41};
  for (int n = 0; n < 60; ++n) {
    const Domain domain = grid(random);
    const auto weights = random_costs(random);
    const auto found = infer_weights(domain, policy_under(domain, weights));
    ASSERT_TRUE(found.is_optimal) << n;
    Direction w(3);
    for (int k = 0; k < 3; ++k) w[k] = weights[static_cast<std::size_t>(k)];
    for (const auto& facet : found.region.facets()) EXPECT_GE(facet.margin(w), -1e-9) << n;
    EXPECT_TRUE(found.unexplained.empty());
    // The same again under the weights that were found.
    const auto again = infer_weights(domain, policy_under(domain, found.weights));
    EXPECT_EQ(again.region, found.region) << n;
  }
}

// A file with the weights that are found is read, also where hardly any are better than others.
TEST(Inference, FindsWeightsThatExactArithmeticTakes) {
  const std::string text = R"(schema = "kith.domain/1"
id = "proportional"
[mdp]
discount = 0.95
actions = ["a0", "a1", "a2", "a3"]
[model]
format = "csv"
states = "s.csv"
transitions = "t.csv"
[[feature]]
name = "f0"
[[feature]]
name = "f1"
[[feature]]
name = "step"
[prior]
halfspaces = [ { step = -1 } ]
)";
  const DomainFiles files{{},
                          {{"s.csv", "state,terminal\ns0,false\ns1,false\ns2,true\n"},
                           {"t.csv",
                            "state,action,next,probability,f0,f1,step\ns0,a0,s1,1,0,0,1\ns0,a1,s2,1,1,2,1\n"
                            "s0,a2,s0,1,0,0,1\ns1,a0,s2,1,0,0,1\ns1,a1,s1,1,2,3,1\ns1,a2,s0,1,0,0,1\n"
                            "s1,a3,s0,1,0,0,1\n"}}};
  const auto open = parse_unweighed_domain(text, "proportional", files);
  ASSERT_TRUE(open.domain) << open.diagnostics.front().message;
  const auto policy = parse_policy("state,action\ns0,a1\ns1,a3\n", "policy.csv", *open.domain);
  ASSERT_TRUE(policy.policy) << policy.diagnostics.front().message;
  const auto found = infer_weights(*open.domain, *policy.policy);
  EXPECT_TRUE(found.is_optimal);
  const auto written = with_inferred_weights(text, open.domain->feature_names(), found.weights, as_inferred(found), {});
  const auto read = parse_domain(written, "written", {}, files);
  EXPECT_TRUE(read.domain) << read.diagnostics.front().message << written;
}

TEST(Inference, NamesOddStatesAndStillExplainsTheRest) {
  RandomStream random{42};
  for (int n = 0; n < 30; ++n) {
    const Domain domain = grid(random);
    const Mdp& mdp = domain.mdp(MdpIndex{0});
    const auto weights = random_costs(random);
    const auto honest = policy_under(domain, weights);
    auto policy = honest;
    std::size_t odd = 0;
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
      if (mdp.choices(s).size() < 2 || uniform01(random) > 0.08) continue;
      take(policy, mdp, 0, s, (choice_of(policy, mdp, 0, s) + 1) % mdp.choices(s).size());
      ++odd;
    }
    const auto found = infer_weights(domain, policy);
    // The true weights explain all but the odd ones, and what was found is as good as these.
    EXPECT_GE(found.share, 1.0 - static_cast<double>(odd) / static_cast<double>(mdp.num_states()) - 1e-12) << n;
    EXPECT_EQ(found.unexplained.size(),
              static_cast<std::size_t>(std::lround((1.0 - found.share) * static_cast<double>(mdp.num_states()))));
    for (const auto& clash : found.clashes) EXPECT_FALSE(has_interior(clash.half_spaces));
    for (const auto& one : found.unexplained)
      EXPECT_TRUE(std::binary_search(found.left_out.begin(), found.left_out.end(), one.state));
  }
}

TEST(Inference, LeavesOutEveryStartThatMeetsWhatIsNotExplained) {
  RandomStream random{43};
  const auto text = grid_text(random, "1.0");
  const Domain open = *parse_unweighed_domain(text, "grid").domain;
  const Mdp& mdp = open.mdp(MdpIndex{0});
  auto policy = policy_under(open, {-2.0, -0.3, -1.0});
  const StateIndex odd{mdp.num_states() / 2};
  take(policy, mdp, 0, odd, (choice_of(policy, mdp, 0, odd) + 1) % mdp.choices(odd).size());
  const auto found = infer_weights(open, policy);
  if (found.is_optimal) GTEST_SKIP() << "the odd action is as good";
  const auto written =
      with_inferred_weights(text, open.feature_names(), found.weights, as_inferred(found), found.left_out);
  const auto reading = parse_domain(written, "inferred");
  ASSERT_TRUE(reading.domain) << reading.diagnostics.front().message;
  EXPECT_EQ(*reading.domain->inferred(), as_inferred(found));
  EXPECT_EQ(reading.domain->num_starts() + found.left_out.size(), open.num_starts());
  const Atlas atlas{*reading.domain};
  std::size_t shown = 0;
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start)) continue;
    ++shown;
    for (const StartIndex on : atlas.path(start)) {
      const auto s = atlas.id(on).start;
      for (const auto& one : found.unexplained) EXPECT_NE(s, one.state.start);
    }
  }
  EXPECT_EQ(shown, reading.domain->num_starts());
}

TEST(Inference, RefusesARobotThatActsAtRandom) {
  RandomStream random{44};
  int refused = 0;
  for (int n = 0; n < 20; ++n) {
    const Domain domain = grid(random);
    const Mdp& mdp = domain.mdp(MdpIndex{0});
    auto policy = policy_under(domain, {-1.0, -1.0, -1.0});
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s)
      take(policy, mdp, 0, s, uniform_index(mdp.choices(s).size(), random));
    try {
      (void)infer_weights(domain, policy);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
      EXPECT_EQ(error.diagnostics().front().id, "E0341");
    }
  }
  EXPECT_GE(refused, 19);  // each is accepted with a chance of at most 5 %
}

TEST(Inference, WeighsHowOftenARobotDoesWhat) {
  RandomStream random{45};
  const Domain domain = grid(random);
  const Mdp& mdp = domain.mdp(MdpIndex{0});
  auto policy = policy_under(domain, {-2.0, -0.3, -1.0});
  const auto sure = infer_weights(domain, policy);
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    const auto n = mdp.choices(s).size();
    for (std::size_t c = 0; c < n; ++c) {
      auto& p = policy.probability[0][mdp.first_choice(s) + c];
      p = 0.8 * p + 0.2 / static_cast<double>(n);
    }
  }
  const auto unsure = infer_weights(domain, policy);
  EXPECT_EQ(unsure.region, sure.region);
  EXPECT_LT(unsure.share, 1.0);
  EXPECT_GT(unsure.share, 0.8);
  EXPECT_FALSE(unsure.is_optimal);
  EXPECT_TRUE(unsure.left_out.empty());
}

TEST(Inference, UsesWhatWasSeenOnly) {
  const auto& atlas = item_delivery();
  auto policy = robots(atlas);
  for (std::size_t m = 0; m < policy.is_seen.size(); m += 2) {
    std::fill(policy.is_seen[m].begin(), policy.is_seen[m].end(), false);
    std::fill(policy.probability[m].begin(), policy.probability[m].end(), 0.0);
  }
  const auto found = infer_weights(atlas.domain(), policy);
  EXPECT_DOUBLE_EQ(found.share, 1.0);
  EXPECT_FALSE(found.left_out.empty());
  for (const auto& id : found.left_out) EXPECT_EQ(id.mdp.value() % 2, 0u);
}

// Without all but some states.
void forget(ObservedPolicy& policy, const Mdp& mdp, double share, RandomStream& random) {
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    if (uniform01(random) >= share) continue;
    policy.is_seen[0][s.value()] = false;
    for (std::size_t c = 0; c < mdp.choices(s).size(); ++c) policy.probability[0][mdp.first_choice(s) + c] = 0.0;
  }
}

// By planning: whether what was seen is best under weights.
bool explains(const Mdp& mdp, const ObservedPolicy& policy, const std::vector<double>& w) {
  const auto plan = behave(mdp, w);
  if (!plan) return false;
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    for (std::size_t c = 0; policy.is_seen[0][s.value()] && c < mdp.choices(s).size(); ++c) {
      if (policy.probability[0][mdp.first_choice(s) + c] > 0.0 && !is_optimal(mdp, *plan, w, s, c)) return false;
    }
  }
  return true;
}

// Half of the policies miss states at random, the others are whole paths: of these the region is exact.
TEST(Inference, HoldsAllWeightsThatExplainWhatWasSeen) {
  RandomStream random{46};
  std::size_t explained = 0, narrowed = 0;
  for (int n = 0; n < 60; ++n) {
    const Domain domain = grid(random);
    const Mdp& mdp = domain.mdp(MdpIndex{0});
    auto policy = policy_under(domain, random_costs(random));
    const bool is_path = n % 2 == 1;
    if (is_path) {
      std::vector<bool> is_on(mdp.num_states(), false);
      for (auto s = domain.initial_state(MdpIndex{0}); !mdp.is_terminal(s);) {
        is_on[s.value()] = true;
        s = mdp.outcomes(mdp.choices(s)[choice_of(policy, mdp, 0, s)]).front().next;
      }
      for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
        policy.is_seen[0][s.value()] = is_on[s.value()];
        for (std::size_t c = 0; !is_on[s.value()] && c < mdp.choices(s).size(); ++c)
          policy.probability[0][mdp.first_choice(s) + c] = 0.0;
      }
    } else {
      forget(policy, mdp, 0.5, random);
    }
    WeightInference found;
    try {
      found = infer_weights(domain, policy);
    } catch (const Error& error) {
      EXPECT_THAT(error.diagnostics().front().id, ::testing::AnyOf("E0341", "E0342", "E0343")) << n;
      continue;
    }
    if (!found.is_optimal) continue;
    EXPECT_TRUE(explains(mdp, policy, found.weights)) << n;
    Cone prior{3};
    ASSERT_TRUE(prior.clip(domain.prior()));
    for (const auto& side : found.sides) EXPECT_TRUE(side.support > 0 || prior.implies(side.half_space)) << n;
    narrowed += found.region == prior ? 0u : 1u;
    for (int i = 0; i < 300; ++i) {
      const auto w = prior.sample(random);
      const bool does = explains(mdp, policy, {w.x(), w.y(), w.z()});
      explained += does ? 1u : 0u;
      EXPECT_TRUE(!does || found.region.contains(w)) << n << ": " << w.transpose();
      double margin = 1.0;
      for (const auto& facet : found.region.facets()) margin = std::min(margin, facet.margin(w));
      const bool is_inside = margin > 1e-6 && behave(mdp, std::vector<double>{w.x(), w.y(), w.z()});
      EXPECT_TRUE(!is_path || !is_inside || does) << n << ": " << w.transpose();
    }
  }
  EXPECT_GT(explained, 1000u);
  EXPECT_GT(narrowed, 30u);
}

const std::string kForks =
    "schema = \"kith.domain/1\"\nid = \"forks\"\n[model]\nformat = \"csv\"\nstates = \"s.csv\"\n"
    "transitions = \"t.csv\"\n[[feature]]\nname = \"mud\"\n[[feature]]\nname = \"step\"\n[prior]\n"
    "halfspaces = [ { step = -1 } ]\n";

// From a: dry (1 step) or muddy (1 mud, 1 step); from b: through (1 mud, 1 step) or around (3 steps).
Domain forks() {
  const DomainFiles files{{},
                          {{"s.csv", "state,terminal\na,false\nb,false\nend,true\n"},
                           {"t.csv",
                            "state,action,next,mud,step\na,dry,end,0,1\na,muddy,end,1,1\n"
                            "b,through,end,1,1\nb,around,end,0,3\n"}}};
  return *parse_unweighed_domain(kForks, "forks", files).domain;
}

WeightInference inferred_of_forks(const std::string& table) {
  const Domain domain = forks();
  return infer_weights(domain, *parse_policy("state,action,probability\n" + table, "policy", domain).policy);
}

TEST(Inference, SaysNothingOfAStateThatWasNotSeen) {
  const auto found = inferred_of_forks("a,dry,1\n");
  EXPECT_THAT(found.region.minimal_set(), ::testing::UnorderedElementsAre(HalfSpace{{-1, 0}}, HalfSpace{{0, -1}}));
  EXPECT_EQ(found.sides.front().half_space, (HalfSpace{{0, -1}})) << "known";
  EXPECT_EQ(found.sides.front().support, 0u);
  EXPECT_EQ(found.sides.back().support, 1u);
  EXPECT_EQ(found.left_out, (std::vector<StartId>{{MdpIndex{0}, StateIndex{1}}}));
}

// Half of the time through the mud, half around it: both are best where 1 mud costs 2 steps.
TEST(Inference, TakesATieForAnExplanation) {
  for (const std::string table : {"b,through,0.5\nb,around,0.5\n", "b,around,0.5\nb,through,0.5\n"}) {
    const auto found = inferred_of_forks("a,dry,1\n" + table);
    EXPECT_TRUE(found.is_optimal);
    EXPECT_DOUBLE_EQ(found.weights[0], 2.0 * found.weights[1]);
    EXPECT_LT(found.weights[1], 0.0);
  }
}

TEST(Inference, RefusesAPolicyOfAnotherDomain) {
  EXPECT_THROW((void)infer_weights(item_delivery().domain(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
