// What a lesson says follows from what it has shown up to there, and priors are optional and may touch the weights.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/bracket.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/target.hpp"
#include "kith/explain/words.hpp"
#include "random_domains.hpp"

namespace kith::laws {
namespace {

// Whether w_k / |w_r| is on the inner side of this end wherever the region is, which tells the sign of w_r.
bool is_within(const Cone& region, const Bracket& bracket, const Ratio& end, int side) {
  const auto rays = region.generators();
  const auto has = [&](int sign) {
    return std::ranges::any_of(rays, [&](const auto& ray) { return sign * ray[bracket.reference] > 0; });
  };
  if (has(1) && has(-1)) return false;
  const int sign = has(-1) ? -1 : 1;
  return std::ranges::all_of(rays, [&](const IntegerVector& ray) {
    return side * (Int128{ray[bracket.feature]} * end.denominator -
                   sign * Int128{ray[bracket.reference]} * end.numerator) >=
           0;
  });
}

// What the paths that are drawn count, in worlds without chance and discount, in units of 1 / scale.
IntegerVector counted_along(const Mdp& mdp, const Trajectory& path, std::int64_t scale) {
  IntegerVector counts(mdp.num_features());
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    const auto choices = mdp.choices(path.states[t]);
    const auto choice = std::ranges::find(choices, path.actions[t], &Choice::action);
    const auto features = mdp.integer_features(mdp.outcomes(*choice).front());
    for (std::size_t k = 0; k < counts.size(); ++k) counts[k] += scale * features[k];
  }
  return counts;
}

// Of how many sentences that was shown; 0 if there is nothing to teach.
std::size_t expect_said_is_shown(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  Curriculum lesson;
  try {
    lesson = make_curriculum(atlas, {.runs = 1, .beliefs = 20});
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible) << error.what();
    return 0;
  }
  std::size_t said = 0;
  Cone shown = atlas.prior_cone();
  for (const auto& component : lesson.components) {
    for (const auto& one : component.demonstrations) {
      SCOPED_TRACE(domain.id() + ": " + one.reason);
      EXPECT_TRUE(shown.clip(one.conveys));
      EXPECT_TRUE(shown.implies(one.main));
      EXPECT_EQ(conveyed_by(domain, one.contrast), one.main);
      const auto& mdp = domain.mdp(atlas.id(one.start).mdp);
      const auto scale = domain.count_scale();
      if (is_exact(mdp)) {
        EXPECT_EQ(counted_along(mdp, one.contrast.robot, scale) - counted_along(mdp, one.contrast.alternative, scale),
                  one.contrast.robot_counts - one.contrast.alternative_counts);
      } else if (mdp.is_deterministic()) {
        EXPECT_EQ(one.reason.find(" tries"), std::string::npos);
        if (one.contrast.robot.repeats_from || one.contrast.alternative.repeats_from) {
          EXPECT_EQ(one.reason.find("steps and"), std::string::npos);
        }
      }
      ++said;
    }
    for (const auto& test : component.tests) {
      auto seen = shown;
      EXPECT_TRUE(seen.clip(atlas.constraints().half_spaces(atlas.one_step(test.start))));
      for (const auto& covered : test.covers) EXPECT_TRUE(seen.implies(covered)) << described(domain, covered);
      said += test.covers.size();
    }
  }
  Cone seen = atlas.prior_cone();  // in the order in which people look
  for (const bool is_first : {true, false}) {
    for (const auto& component : lesson.components) {
      for (const auto& one : component.demonstrations) {
        if (one.is_first != is_first) continue;
        EXPECT_TRUE(seen.clip(one.conveys));
        for (const auto& bracket : one.brackets) {
          EXPECT_TRUE(!bracket.low || is_within(seen, bracket, *bracket.low, 1));
          EXPECT_TRUE(!bracket.high || is_within(seen, bracket, *bracket.high, -1));
          said += 2;
        }
      }
    }
  }
  for (const auto& component : lesson.components) {
    for (const auto& constraint : component.constraints) EXPECT_TRUE(shown.implies(constraint));
  }
  return said;
}

DomainText random_robot(std::uint64_t i) {
  const auto random = RandomStream{55}.split(i);
  switch (i % 5) {
    case 0:
    case 1:
      return random_map(random);
    case 2:
      return random_model(random, 0.2);
    case 3:
      return with_discount(random_model(random, 0.0), 0.9);
    default:
      return i < 5 ? robot_that_never_ends() : with_discount(random_map(random), 0.8);
  }
}

void expect_of_random(std::uint64_t n) {
  std::size_t said = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto text = random_robot(i);
    SCOPED_TRACE(text.toml());
    const auto reading = text.read();
    if (!reading.domain) continue;
    try {
      said += expect_said_is_shown(Atlas{*reading.domain});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInfeasible) << error.what();
    }
  }
  EXPECT_GT(said, 2 * n);
}

TEST(SaidIsShown, InLessonsOfRandomRobots) { expect_of_random(50); }
TEST(SaidIsShownSlow, InLessonsOfRandomRobots) { expect_of_random(600); }

TEST(SaidIsShown, InLessonsOfSmallDomains) {
  for (const std::string name : {"item-delivery", "two-goals", "cookie-crumb", "frozen_lake", "cliff_walking"}) {
    const auto path = std::string{KITH_SOURCE_DIR} + "/domains/gallery/" + name + ".toml";
    expect_said_is_shown(Atlas{load_domain(name.find('_') == std::string::npos ? name : path)});
  }
}
TEST(SaidIsShownSlow, InLessonsOfAllDomains) {
  for (const auto& text : known_domains()) expect_said_is_shown(Atlas{*text.read().domain});
}

// --- priors ----------------------------------------------------------------------------------------------------------

DomainText with_prior(DomainText text, TomlArray half_spaces) {
  TomlTable prior;
  prior.append({"halfspaces", {}, TomlValue{std::move(half_spaces)}});
  text.root.set({"prior", {}, TomlValue{std::move(prior)}});
  return text;
}

// A robot with d features that chooses once or twice.
DomainText choices_among(std::size_t d, RandomStream random) {
  DomainText text{"choices", {}, {}};
  std::string toml =
      "schema = \"kith.domain/1\"\nid = \"choices\"\n[model]\nformat = \"csv\"\nstates = \"s.csv\"\n"
      "transitions = \"t.csv\"\n";
  std::string weights, table = "state,action,next";
  for (std::size_t k = 0; k < d; ++k) {
    const auto name = "f" + std::to_string(k);
    toml += "[[feature]]\nname = \"" + name + "\"\n";
    const auto weight = static_cast<int>(uniform_index(7, random)) - 3;
    weights += (k == 0 ? "" : ", ") + name + " = " + std::to_string(k + 1 == d ? -1 : weight);
    table += "," + name;
  }
  table += "\n";
  for (const std::string state : {"a", "b"}) {
    for (int action = 0; action < 3; ++action) {
      table += state + ",x" + std::to_string(action) + (state == "a" && action > 0 ? ",b" : ",end");
      for (std::size_t k = 0; k < d; ++k) table += "," + std::to_string(uniform_index(3, random));
      table += "\n";
    }
  }
  return domain_text("choices",
                     toml + "[reward]\nweights = { " + weights + " }\n[prior]\nhalfspaces = [ { f" +
                         std::to_string(d - 1) + " = -1 } ]\n",
                     {{"s.csv", "state,terminal\na,false\nb,false\nend,true\n"}, {"t.csv", table}});
}

// Whatever is computed for the commands that look at a domain or teach it.
void expect_everything_works(const DomainText& text) {
  SCOPED_TRACE(text.toml());
  const auto reading = text.read();
  ASSERT_TRUE(reading.domain);
  try {
    const Atlas atlas{*reading.domain};
    EXPECT_GT(atlas.policy_bec_area().value, 0.0);
    expect_said_is_shown(atlas);
    for (const auto& one : isolated_constraints(atlas)) {
      static_cast<void>(simplest_isolating(atlas, one.constraint, Purpose::kTeach));
      static_cast<void>(simplest_isolating(atlas, one.constraint, Purpose::kTest));
    }
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible) << error.what();
  }
}

// Half-spaces that hold with equality at the robot's weights, of two features each.
TomlArray touching(const Domain& domain) {
  const auto& weights = domain.weights().integer;
  TomlArray all;
  for (std::size_t k = 0; k + 1 < domain.num_features(); ++k) {
    TomlTable normal;
    normal.append({domain.feature_names()[k], {}, TomlValue{weights[k + 1]}});
    normal.append({domain.feature_names()[k + 1], {}, TomlValue{-weights[k]}});
    if (weights[k] != 0 || weights[k + 1] != 0) all.emplace_back(std::move(normal));
  }
  return all;
}

void expect_any_prior(const DomainText& text) {
  expect_everything_works(with_prior(text, {}));
  const auto reading = text.read();
  ASSERT_TRUE(reading.domain);
  for (const auto& one : touching(*reading.domain)) expect_everything_works(with_prior(text, {one}));
}

TEST(Prior, IsOptionalAndMayTouchTheWeights) {
  for (std::uint64_t i = 0; i < 30; ++i) expect_any_prior(choices_among(2 + i % 6, RandomStream{10}.split(i)));
  for (const auto& text : known_domains()) {
    for (const char* name : {"item-delivery", "hospital", "cliff-walking", "two-goals"}) {
      if (text.name == name) expect_everything_works(with_prior(text, {}));
    }
  }
}
TEST(PriorSlow, IsOptionalAndMayTouchTheWeights) {
  for (const auto& text : known_domains()) expect_any_prior(text);
}

}  // namespace
}  // namespace kith::laws
