// Normals, and what is made of them: beliefs.
#include <algorithm>
#include <cmath>
#include <string>

#include "cases.hpp"
#include "evidence.hpp"
#include "kith/belief/team_belief.hpp"
#include "kith/random/batch_normal.hpp"
#include "naive_filter.hpp"

namespace kith::bench {
namespace {

constexpr std::size_t kConstraints = 3;

std::string out_of_line(const std::string& what, double kith, double rival) {
  return what + ": " + std::to_string(kith) + " and, of the rival, " + std::to_string(rival);
}

// Mean and variance of many normals: within 5 standard errors of 0 and 1, of either.
std::string normals_disagree() {
  std::vector<double> ours, theirs(400 * 2 * NormalPairs::kBlock);
  RandomStream random{1};
  const NormalPairs normal{random};
  NormalPairs::Block cosine, sine;
  for (std::uint64_t block = 0; ours.size() < theirs.size(); ++block) {
    normal.fill(block, cosine, sine);
    ours.insert(ours.end(), cosine.begin(), cosine.end());
    ours.insert(ours.end(), sine.begin(), sine.end());
  }
  naive_normals(theirs, random);
  const auto n = static_cast<double>(ours.size());
  for (const auto* values : {&ours, &theirs}) {
    double sum = 0.0, squares = 0.0;
    for (const double x : *values) {
      sum += x;
      squares += x * x;
    }
    if (std::abs(sum / n) > 5.0 / std::sqrt(n)) return "the mean of normals is " + std::to_string(sum / n);
    if (std::abs(squares / n - 1.0) > 5.0 * std::sqrt(2.0 / n))
      return "the variance of normals is " + std::to_string(squares / n);
  }
  return {};
}

Prepared normals(Workbench& /*bench*/) {
  constexpr std::size_t kBlocks = 4;
  Prepared prepared;
  prepared.work = [random = RandomStream{1}](std::size_t rounds) mutable {
    NormalPairs::Block cosine, sine;
    for (; rounds > 0; --rounds) {
      const NormalPairs normal{random};
      for (std::uint64_t block = 0; block < kBlocks; ++block) {
        normal.fill(block, cosine, sine);
        keep(cosine[0]);
      }
    }
  };
  prepared.rival = [out = std::vector<double>(kBlocks * 2 * NormalPairs::kBlock),
                    random = RandomStream{1}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds) {
      naive_normals(out, random);
      keep(out[0]);
    }
  };
  prepared.disagreement = normals_disagree;
  return prepared;
}

// Weights follow from points and evidence alone: equal up to rounding.
std::string weights_disagree() {
  const Evidence evidence{kConstraints};
  const HalfSpaceLikelihood likelihood{0.8};
  ParticleBelief belief{prior_cone(), {.resample_below = 0.0}};
  NaiveFilter rival{belief, prior_half_spaces(), RandomStream{2}};
  for (std::uint64_t turn = 0; turn < 3; ++turn) {
    belief.observe(evidence.half_spaces, likelihood, RandomStream{2});
    rival.observe(evidence.half_spaces, likelihood);
  }
  for (std::size_t i = 0; i < belief.size(); ++i) {
    const double ours = belief.weights()[i], theirs = rival.weights()[i];
    if (std::abs(ours - theirs) > 1e-10 * theirs)
      return out_of_line("the weight of particle " + std::to_string(i), ours, theirs);
  }
  return {};
}

// Points are drawn: the two clouds agree as two runs of one filter do. The bounds are 5 standard errors: after one
// resampling of 1 000 points a mean direction is known to spread / sqrt(1000), a spread to about 1 / sqrt(1000) of it.
std::string clouds_disagree() {
  const Evidence evidence{kConstraints};
  const HalfSpaceLikelihood likelihood{0.8};
  ParticleBelief belief{prior_cone(), {.resample_below = 1.0}};
  NaiveFilter rival{belief, prior_half_spaces(), RandomStream{2}};
  belief.observe(evidence.half_spaces, likelihood, RandomStream{2});
  rival.observe(evidence.half_spaces, likelihood);
  const double n = std::sqrt(static_cast<double>(belief.size()));
  const double between = std::acos(std::clamp(belief.mean_direction().dot(rival.mean_direction()), -1.0, 1.0));
  if (between > 5.0 * belief.spread() / n) return "mean directions are " + std::to_string(between) + " rad apart";
  if (std::abs(belief.spread() / rival.spread() - 1.0) > 5.0 / n)
    return out_of_line("the spread", belief.spread(), rival.spread());
  return {};
}

Prepared update(double resample_below, std::function<std::string()> disagreement) {
  const Evidence evidence{kConstraints};
  const HalfSpaceLikelihood likelihood{0.8};
  const ParticleBelief start{prior_cone(), {.resample_below = resample_below}};
  Prepared prepared;
  prepared.work = [=, belief = start, turn = std::uint64_t{0}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds, ++turn) {
      if (turn % kSession == 0) belief = start;
      belief.observe(evidence.at(turn), likelihood, RandomStream{2}.split(turn));
    }
    keep(belief.weights()[0]);
  };
  const NaiveFilter first{start, prior_half_spaces(), RandomStream{2}};
  prepared.rival = [=, filter = first, turn = std::uint64_t{0}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds, ++turn) {
      if (turn % kSession == 0) filter = first;
      filter.observe(evidence.at(turn), likelihood);
    }
    keep(filter.weights()[0]);
  };
  prepared.disagreement = std::move(disagreement);
  return prepared;
}

Prepared weigh(Workbench& /*bench*/) { return update(0.0, weights_disagree); }
Prepared step(Workbench& /*bench*/) { return update(1.0, clouds_disagree); }

Prepared team_period(Workbench& /*bench*/) {
  const auto list = Evidence{kConstraints}.half_spaces;
  const std::vector<std::vector<HalfSpace>> responses{list, {list[0].opposite()}, {list[1]}};
  const TeamBelief start{prior_cone(), {}, {RandomStream{1}, RandomStream{2}, RandomStream{3}}, RandomStream{4}};
  Prepared prepared;
  prepared.work = [=, team = start, period = std::uint64_t{0}](std::size_t rounds) mutable {
    for (; rounds > 0; --rounds) {
      ++period;
      team.observe_demonstrations(list, period);
      keep(team.observe_responses(responses, period).size());
      team.observe_feedback(list, period);
    }
  };
  return prepared;
}

}  // namespace

void add_belief_cases(std::vector<Case>& cases) {
  cases.push_back(
      {"random.normals", "2 000 standard normals", "one pair after the other, C library", Clock::kCpu, false, normals});
  cases.push_back({"belief.weigh", "1 000 particles weighed by 3 constraints", "scalar doubles, std::exp", Clock::kCpu,
                   false, weigh});
  cases.push_back({"belief.step", "a filter step: weigh, resample and move 1 000 particles",
                   "scalar doubles, std::exp, log, sin and cos", Clock::kCpu, false, step});
  cases.push_back(
      {"belief.team-period", "a period of three members, with all beliefs", "", Clock::kCpu, false, team_period});
}

}  // namespace kith::bench
