// How cost grows with the sizes of studies and domains.
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "cases.hpp"
#include "evidence.hpp"
#include "kith/belief/particle_belief.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/random/distributions.hpp"
#include "kith/study/study.hpp"

namespace kith::bench {
namespace {

double as_double(std::size_t n) { return static_cast<double>(n); }

// Updates of a belief that begins anew now and then, as in sessions.
Work update(std::size_t constraints, const FilterOptions& options) {
  const Evidence evidence{constraints};
  const ParticleBelief start{prior_cone(), options};
  return [=, belief = start, turn = std::uint64_t{0}](std::size_t rounds) mutable {
    const HalfSpaceLikelihood likelihood{0.8};
    for (; rounds > 0; --rounds, ++turn) {
      if (turn % kSession == 0) belief = start;
      belief.observe(evidence.at(turn), likelihood, RandomStream{2}.split(turn));
    }
    keep(belief.weights()[0]);
  };
}

Work step_of(std::size_t particles) { return update(3, {.particles = particles, .resample_below = 1.0}); }
Work weigh_by(std::size_t constraints) { return update(constraints, {.resample_below = 0.0}); }

// Teams of the four group strategies on one thread, with these overrides; only teams and learners are recorded.
std::shared_ptr<const Study> study_with(std::vector<std::string> overrides, std::size_t replicates) {
  overrides.insert(overrides.begin(), {R"(design.strategies=["individual-low", "individual-high", "common", "joint"])",
                                       R"(record.level="team")", "replicates=" + std::to_string(replicates)});
  auto reading = load_study("paper-uncalibrated", {overrides});
  if (!reading.study) throw Error{reading.diagnostics};
  return std::make_shared<const Study>(std::move(*reading.study));
}

Work teach(const std::shared_ptr<const Atlas>& atlas, const std::shared_ptr<const Study>& study) {
  return [=](std::size_t rounds) {
    RunOptions options;
    options.threads = 1;
    for (; rounds > 0; --rounds) keep(run_teams(*atlas, *study, team_addresses(*study), options).teams.size());
  };
}

// On the workbench's atlas, which outlives all work.
Work teach(Workbench& bench, const std::string& override, std::size_t replicates) {
  std::vector<std::string> overrides;
  if (!override.empty()) overrides.push_back(override);
  return teach(std::shared_ptr<const Atlas>{std::shared_ptr<const Atlas>{}, &bench.atlas()},
               study_with(std::move(overrides), replicates));
}

constexpr double kCells = 16.0;  // four strategies, four compositions

Growth by_key(const std::string& name, const std::string& size, const std::string& key,
              const std::vector<std::size_t>& values) {
  Growth growth{"growth." + name, "a team of three, level team", size, Clock::kCpu, {}};
  constexpr std::size_t kReplicates = 2;
  for (const auto value : values) {
    growth.points.push_back(
        {as_double(value),
         [=](Workbench& bench) { return teach(bench, key + "=" + std::to_string(value), kReplicates); },
         kCells * as_double(kReplicates)});
  }
  return growth;
}

Growth by_members() {
  Growth growth{"growth.members", "a team of novices, level team", "members", Clock::kCpu, {}};
  constexpr std::size_t kReplicates = 6;
  for (const std::size_t members : {1u, 2u, 3u, 6u, 12u}) {
    growth.points.push_back({as_double(members),
                             [=](Workbench& bench) {
                               return teach(bench, "design.compositions=[\"" + std::string(members, 'N') + "\"]",
                                            kReplicates);
                             },
                             4.0 * as_double(kReplicates)});
  }
  return growth;
}

Growth by_teams() {
  Growth growth{"growth.teams", "a study, level team, in memory", "teams", Clock::kCpu, {}};
  for (const std::size_t replicates : {2u, 8u, 32u}) {
    growth.points.push_back(
        {kCells * as_double(replicates), [=](Workbench& bench) { return teach(bench, "", replicates); }, 1.0});
  }
  return growth;
}

// Item delivery with the charger and so many cells of rubble optional, the others free: 2^optional MDPs.
Domain delivery_with(std::size_t optional) {
  std::array<std::string, 3> rows{"#..B", "#...", "G..S"};
  static constexpr std::array<std::pair<std::size_t, std::size_t>, 7> kPlaces{
      {{0, 2}, {1, 1}, {1, 2}, {1, 3}, {2, 2}, {0, 1}, {2, 1}}};
  for (std::size_t i = 0; i + 1 < optional; ++i) rows[kPlaces[i].first][kPlaces[i].second] = 'r';
  const std::string text = "schema = \"kith.domain/1\"\nid = \"delivery\"\n[mdp]\nmax_steps = 60\n[map]\nrows = [\"" +
                           rows[0] + "\", \"" + rows[1] + "\", \"" + rows[2] +
                           "\"]\n"
                           "[map.legend]\n\"#\" = \"wall\"\n\".\" = \"floor\"\n"
                           "\"r\" = { terrain = \"rubble\", optional = true }\n"
                           "\"B\" = { station = \"charger\", optional = true }\n"
                           "\"S\" = { start = true, item = \"parcel\" }\n\"G\" = { destination = \"parcel\" }\n"
                           "[[feature]]\nname = \"rubble\"\nwhen = \"leave:rubble\"\n"
                           "[[feature]]\nname = \"recharge\"\nwhen = \"leave:charger\"\n"
                           "[[feature]]\nname = \"step\"\nwhen = \"action\"\n"
                           "[reward]\nweights = { rubble = -3.0, recharge = 3.5, step = -1.0 }\n"
                           "[prior]\nhalfspaces = [ { step = -1 } ]\n";
  auto reading = parse_domain(text, "delivery");
  if (!reading.domain) throw Error{reading.diagnostics};
  return std::move(*reading.domain);
}

constexpr std::array<std::size_t, 5> kOptional{3, 4, 5, 6, 8};

Growth atlas_by_worlds() {
  Growth growth{"growth.worlds", "the atlas of a delivery domain", "MDPs", Clock::kCpu, {}};
  for (const auto optional : kOptional) {
    growth.points.push_back({as_double(std::size_t{1} << optional),
                             [=](Workbench&) -> Work {
                               return [domain = delivery_with(optional)](std::size_t rounds) {
                                 for (; rounds > 0; --rounds) keep(Atlas{domain}.num_demos());
                               };
                             },
                             1.0});
  }
  return growth;
}

Growth teams_by_worlds() {
  Growth growth{"growth.worlds-team", "a team of three, level team, in such a domain", "MDPs", Clock::kCpu, {}};
  constexpr std::size_t kReplicates = 2;
  for (const auto optional : kOptional) {
    growth.points.push_back({as_double(std::size_t{1} << optional),
                             [=](Workbench&) {
                               return teach(std::make_shared<const Atlas>(delivery_with(optional)),
                                            study_with({}, kReplicates));
                             },
                             kCells * as_double(kReplicates)});
  }
  return growth;
}

// An open grid with the goal in a corner; the last feature counts steps, the others one kind of cell each.
Mdp grid(std::size_t side, std::size_t features) {
  RandomStream random{side};
  const std::size_t goal = side * side - 1;
  MdpBuilder builder{goal, 1, 4, features, 1.0};
  for (std::size_t s = 0; s < goal; ++s) {
    std::vector<double> phi(features, 0.0);
    phi[uniform_index(features, random)] = 1.0;
    phi.back() = 1.0;
    const std::size_t x = s % side, y = s / side;
    const std::array<bool, 4> is_open{y + 1 < side, y > 0, x > 0, x + 1 < side};
    const std::array<std::size_t, 4> next{s + side, s - side, s - 1, s + 1};
    for (std::size_t a = 0; a < 4; ++a) {
      if (!is_open[a]) continue;
      const MdpBuilder::Transition transition{StateIndex{next[a]}, 1.0, phi};
      builder.add_choice(StateIndex{s}, ActionIndex{a}, std::span{&transition, 1});
    }
  }
  return std::move(builder).build();
}

Work plan_grid(std::size_t side, std::size_t features) {
  std::vector<double> weights(features, -1.0);
  for (std::size_t k = 0; k < features; ++k) weights[k] -= 0.3 * as_double(k);
  return [=, mdp = grid(side, features)](std::size_t rounds) {
    for (; rounds > 0; --rounds) keep(behave(mdp, weights));
  };
}

Growth by_features() {
  Growth growth{"growth.features", "the plan of a grid of 12 x 12 states", "features", Clock::kCpu, {}};
  for (const std::size_t features : {1u, 2u, 3u, 4u, 6u, 8u}) {
    growth.points.push_back({as_double(features), [=](Workbench&) { return plan_grid(12, features); }, 1.0});
  }
  return growth;
}

Growth by_states() {
  Growth growth{"growth.states", "the plan of a square grid, 3 features", "states", Clock::kCpu, {}};
  for (const std::size_t side : {6u, 12u, 24u, 48u}) {
    growth.points.push_back({as_double(side * side), [=](Workbench&) { return plan_grid(side, 3); }, 1.0});
  }
  return growth;
}

Growth by_particles() {
  Growth growth{"growth.particles", "a filter step with 3 constraints", "particles", Clock::kCpu, {}};
  for (const std::size_t particles : {250u, 500u, 1000u, 2000u, 4000u, 16000u}) {
    growth.points.push_back({as_double(particles), [=](Workbench&) { return step_of(particles); }, 1.0});
  }
  return growth;
}

Growth by_constraints() {
  Growth growth{"growth.constraints", "1 000 particles weighed", "constraints", Clock::kCpu, {}};
  for (const std::size_t constraints : {1u, 3u, 8u, 20u}) {
    growth.points.push_back({as_double(constraints), [=](Workbench&) { return weigh_by(constraints); }, 1.0});
  }
  return growth;
}

}  // namespace

const std::vector<Growth>& all_growths() {
  static const std::vector<Growth> kGrowths{
      by_particles(),
      by_constraints(),
      by_features(),
      by_states(),
      atlas_by_worlds(),
      teams_by_worlds(),
      by_members(),
      by_key("counterfactuals", "counterfactuals", "teacher.counterfactuals", {2, 8, 32, 128}),
      by_key("teacher-particles", "particles of the teacher", "teacher.particles", {250, 1000, 4000}),
      by_teams()};
  return kGrowths;
}

double growth_exponent(const std::vector<double>& sizes, const std::vector<double>& costs) {
  const auto n = as_double(sizes.size());
  std::vector<double> x, y;
  for (const double size : sizes) x.push_back(std::log(size));
  for (const double cost : costs) y.push_back(std::log(cost));
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    products += (x[i] - mean_x) * (y[i] - mean_y);
    squares += (x[i] - mean_x) * (x[i] - mean_x);
  }
  return products / squares;
}

}  // namespace kith::bench
