#include "kith/analysis/study_power.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "kith/analysis/distributions.hpp"
#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/power.hpp"
#include "kith/core/distributions.hpp"
#include "study_tests.hpp"

namespace kith {
namespace {

// The first `size` places of a random permutation of 0 .. n - 1.
std::vector<std::uint32_t> sample(std::size_t n, std::size_t size, RandomStream random) {
  std::vector<std::uint32_t> all(n);
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  for (std::size_t k = 0; k < size; ++k) std::swap(all[k], all[k + uniform_index(n - k, random)]);
  all.resize(size);
  return all;
}

// Smaller studies are the first teams of larger ones, so that curves are smooth.
Draw draw_study(const TeamPool& pool, std::size_t teams, bool paired, const RandomStream& random) {
  const auto compositions = pool.compositions().size();
  Draw draw;
  for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
    for (std::size_t c = 0; c < compositions; ++c) {
      if (paired && s > 0) {
        draw.push_back(draw[c]);
      } else {
        draw.push_back(sample(pool.replicates(), teams, random.split(s).split(c)));
      }
    }
  }
  return draw;
}

// Variance of the share of significant studies that comes from the pool.
double pool_variance(const TeamPool& pool, const std::vector<Draw>& draws, const std::vector<char>& significant,
                     double power, std::size_t teams, bool paired) {
  const auto n = static_cast<double>(teams);
  const auto pool_size = static_cast<double>(pool.replicates());
  const auto num_draws = static_cast<double>(draws.size());
  const double binomial = power * (1.0 - power);
  const auto rows = paired ? pool.compositions().size() : draws.front().size();
  double sum = 0.0;
  std::vector<double> covariance(pool.replicates());
  for (std::size_t row = 0; row < rows; ++row) {
    std::fill(covariance.begin(), covariance.end(), 0.0);
    for (std::size_t b = 0; b < draws.size(); ++b) {
      const double deviation = (significant[b] != 0 ? 1.0 : 0.0) - power;
      for (std::size_t k = 0; k < teams; ++k) covariance[draws[b][row][k]] += deviation / num_draws;
    }
    for (const double one : covariance) sum += one * one;
  }
  const double noise = static_cast<double>(rows) * n * (1.0 - n / pool_size) * binomial / num_draws;
  const double stretch = pool_size / (pool_size - n);
  return std::clamp((sum - noise) * stretch * stretch, 0.0, binomial * n / pool_size);
}

// Wilson's interval for a share whose variance is that of `trials` independent ones.
void set_interval(PowerPoint& point, double trials) {
  const double z = normal_quantile(0.975);
  const double p = point.power;
  const double centre = (p + z * z / (2.0 * trials)) / (1.0 + z * z / trials);
  const double half = z / (1.0 + z * z / trials) * std::sqrt(p * (1.0 - p) / trials + z * z / (4.0 * trials * trials));
  point.low = std::max(0.0, centre - half);
  point.high = std::min(1.0, centre + half);
}

PowerPoint point_of(const TeamPool& pool, const std::vector<Draw>& draws, const std::vector<char>& significant,
                    std::size_t teams, bool paired) {
  const auto num_draws = static_cast<double>(draws.size());
  PowerPoint point;
  point.teams = teams;
  point.power = static_cast<double>(std::count(significant.begin(), significant.end(), char{1})) / num_draws;
  const double variance = pool_variance(pool, draws, significant, point.power, teams, paired);
  point.pool_error = std::sqrt(variance);
  const double binomial = point.power * (1.0 - point.power);
  const double trials = binomial > 0.0 ? binomial / (variance + binomial / num_draws) : num_draws;
  set_interval(point, trials);
  return point;
}

// --- how many ---------------------------------------------------------------------

// The nearest rising sequence (pool adjacent violators).
std::vector<double> rising(const std::vector<double>& values) {
  std::vector<std::pair<double, std::size_t>> blocks;  // sum, count
  for (const double value : values) {
    blocks.emplace_back(value, 1);
    while (blocks.size() > 1) {
      const auto& last = blocks[blocks.size() - 1];
      auto& before = blocks[blocks.size() - 2];
      if (before.first / static_cast<double>(before.second) <= last.first / static_cast<double>(last.second)) break;
      before = {before.first + last.first, before.second + last.second};
      blocks.pop_back();
    }
  }
  std::vector<double> result;
  for (const auto& [sum, count] : blocks) result.insert(result.end(), count, sum / static_cast<double>(count));
  return result;
}

// Where the curve reaches the target: straight between points in the normal quantile of power over sqrt(n), as for a
// test of a normal mean. The smallest size if that suffices; nothing if the largest does not.
std::optional<double> crossing(const std::vector<std::size_t>& teams, const std::vector<double>& powers,
                               double target) {
  const auto curve = rising(powers);
  if (curve.front() >= target) return static_cast<double>(teams.front());
  constexpr double kEdge = 1e-6;
  const auto probit = [&](double p) { return normal_quantile(std::clamp(p, kEdge, 1.0 - kEdge)); };
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (curve[i] < target) continue;
    const double below = probit(curve[i - 1]), above = probit(curve[i]);
    const double share = above > below ? (probit(target) - below) / (above - below) : 1.0;
    const double from = std::sqrt(static_cast<double>(teams[i - 1])), to = std::sqrt(static_cast<double>(teams[i]));
    const double root = from + std::clamp(share, 0.0, 1.0) * (to - from);
    return root * root;
  }
  return std::nullopt;
}

std::optional<std::size_t> analytic_teams(const TeamPool& pool, const Effect& effect, double size,
                                          const PowerOptions& options) {
  const auto enough = [&](std::size_t n) {
    const auto power = analytic_power(pool, effect, size, n, options.alpha, options.paired);
    return power && *power >= options.target;
  };
  constexpr std::size_t kMost = 1'000'000;
  std::size_t high = 2;
  while (!enough(high)) {
    high *= 2;
    if (high > kMost) return std::nullopt;
  }
  std::size_t low = 1;
  while (high - low > 1) {
    const auto middle = low + (high - low) / 2;
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

TeamsNeeded needed(const TeamPool& pool, const PowerCurve& curve, const PowerOptions& options) {
  std::vector<double> power, low, high;
  for (const auto& point : curve.points) {
    power.push_back(point.power);
    low.push_back(point.low);
    high.push_back(point.high);
  }
  return {crossing(options.teams, power, options.target), crossing(options.teams, high, options.target),
          crossing(options.teams, low, options.target), analytic_teams(pool, curve.effect, curve.size, options)};
}

void check(const TeamPool& pool, const PowerOptions& options) {
  const auto& teams = options.teams;
  if (teams.empty() || teams.front() < 2 || !std::is_sorted(teams.begin(), teams.end()))
    throw std::invalid_argument{"power_curves: numbers of teams must ascend from 2"};
  if (!(options.alpha > 0.0 && options.alpha < 1.0 && options.target > 0.0 && options.target < 1.0))
    throw std::invalid_argument{"power_curves: alpha and target must lie between 0 and 1"};
  if (options.draws < 2) throw std::invalid_argument{"power_curves: fewer than two draws"};
  if (pool.replicates() < 2 * teams.back())
    throw std::invalid_argument{"power_curves: the pool needs twice the teams of the largest study"};
}

bool is_two_way(const Effect& effect) {
  return effect.kind == Effect::Kind::kStrategy || effect.kind == Effect::Kind::kComposition ||
         effect.kind == Effect::Kind::kInteraction;
}

// p-values of all effects in one drawn study; effects as simulated share their analysis of variance.
std::vector<double> p_values(const StudyTests& tests, std::span<const Effect> effects, std::span<const EffectData> data,
                             const Draw& draw) {
  std::map<const StudyOutcome*, std::array<double, 3>> shared;
  std::vector<double> result;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const auto& effect = effects[e];
    if (effect.imposed || !is_two_way(effect)) {
      result.push_back(tests.p_value(effect, data[e], draw));
      continue;
    }
    auto found = shared.find(effect.outcome);
    if (found == shared.end()) found = shared.emplace(effect.outcome, tests.two_way(data[e], draw)).first;
    result.push_back(found->second[static_cast<std::size_t>(effect.kind)]);
  }
  return result;
}

}  // namespace

std::vector<PowerCurve> power_curves(const TeamPool& pool, std::span<const Effect> effects,
                                     const PowerOptions& options) {
  check(pool, options);
  const auto random = RandomStream{options.seed}.split("power");
  std::vector<Draw> draws;
  for (std::size_t b = 0; b < options.draws; ++b)
    draws.push_back(draw_study(pool, options.teams.back(), options.paired, random.split(b)));
  std::vector<PowerCurve> curves;
  std::vector<EffectData> data;
  for (const auto& effect : effects) {
    curves.push_back({effect, effect.imposed.value_or(effect_size(pool, effect)), {}, {}});
    data.emplace_back(pool, effect);
  }
  for (const auto teams : options.teams) {
    const StudyTests tests{pool, teams, options.paired};
    std::vector<std::vector<char>> significant(effects.size());
    for (const auto& draw : draws) {
      const auto p = p_values(tests, effects, data, draw);
      for (std::size_t e = 0; e < effects.size(); ++e) significant[e].push_back(p[e] < options.alpha ? 1 : 0);
    }
    for (std::size_t e = 0; e < effects.size(); ++e) {
      auto point = point_of(pool, draws, significant[e], teams, options.paired);
      point.analytic_power = analytic_power(pool, effects[e], curves[e].size, teams, options.alpha, options.paired);
      curves[e].points.push_back(point);
    }
  }
  for (auto& curve : curves) curve.needed = needed(pool, curve, options);
  return curves;
}

// --- repetition -------------------------------------------------------------------

namespace {

// Every team of a study, in its own place.
Draw whole(const TeamPool& pool) {
  std::vector<std::uint32_t> all(pool.replicates());
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  return Draw(pool.strategies().size() * pool.compositions().size(), all);
}

// The power that a study of this size has for effects of the published sizes.
void add_published_power(Replication& result, std::span<const PublishedFinding> findings, const TeamPool& pool,
                         std::size_t teams, const ReplicationOptions& replication) {
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto& finding = findings[i];
    if (!finding.f || finding.effect.kind == Effect::Kind::kContrast) continue;
    auto& outcome = result.findings[i];
    outcome.published_eta_squared = eta_squared_of_f(*finding.f, *finding.df1, *finding.df2);
    if (!(*outcome.published_eta_squared > 0.0)) continue;
    auto imposed = finding.effect;
    imposed.imposed = *outcome.published_eta_squared;
    PowerOptions options;
    options.teams = {teams};
    options.alpha = finding.alpha;
    options.seed = replication.seed;
    options.paired = replication.paired;
    const auto curves = power_curves(pool, std::span{&imposed, 1}, options);
    outcome.imposed_power = curves.front().points.front();
    outcome.analytic_power = outcome.imposed_power->analytic_power;
  }
}

}  // namespace

std::optional<Replication> replicate_findings(const Atlas& atlas, const StudySpec& spec,
                                              std::span<const PublishedFinding> findings,
                                              const ReplicationOptions& options) {
  if (options.studies < 1) throw std::invalid_argument{"replicate_findings: no study to run"};
  Study study;
  const auto seeds = RandomStream{options.seed}.split("replication");
  std::vector<const StudyOutcome*> quantities;
  for (const auto& finding : findings) quantities.push_back(finding.effect.outcome);
  for (std::size_t k = 0; k < options.studies; ++k) {
    auto variant = recording(spec, quantities);
    variant.seed = seeds.split(k).address();
    study.variants.push_back(std::move(variant));
  }
  const auto pools = simulate_pools(atlas, study, {.threads = options.threads, .on_progress = options.on_progress});
  if (!pools) return std::nullopt;

  Replication result;
  result.studies = options.studies;
  result.findings.resize(findings.size());
  std::vector<Effect> effects;
  for (const auto& finding : findings) effects.push_back(finding.effect);
  double agreements = 0.0;
  for (const auto& pool : *pools) {
    const StudyTests tests{pool, spec.replicates, options.paired};
    std::vector<EffectData> data;
    for (const auto& effect : effects) data.emplace_back(pool, effect);
    const auto p = p_values(tests, effects, data, whole(pool));
    std::size_t agree = 0;
    for (std::size_t i = 0; i < findings.size(); ++i) {
      const bool significant = p[i] < findings[i].alpha;
      result.findings[i].significant += significant ? 1u : 0u;
      agree += significant == findings[i].significant ? 1u : 0u;
    }
    result.all_agree += agree == findings.size() ? 1u : 0u;
    agreements += static_cast<double>(agree);
  }
  result.mean_agreement = agreements / static_cast<double>(options.studies);
  for (auto& outcome : result.findings) {
    const auto interval = wilson_interval(outcome.significant, options.studies);
    outcome.low = interval.low;
    outcome.high = interval.high;
  }
  // All teams of all studies together are the pool for imposed effects.
  if (options.studies >= 2) add_published_power(result, findings, TeamPool::joined(*pools), spec.replicates, options);
  return result;
}

}  // namespace kith
