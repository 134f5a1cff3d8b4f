#include "study_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "blocks.hpp"
#include "kith/analysis/anova.hpp"
#include "kith/analysis/distributions.hpp"
#include "kith/analysis/moments.hpp"
#include "kith/analysis/power.hpp"
#include "kith/analysis/tests.hpp"
#include "kith/files/column_names.hpp"

namespace kith {
namespace {

std::vector<std::size_t> group_positions(const TeamPool& pool) {
  std::vector<std::size_t> groups;
  for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
    if (pool.strategies()[s] != kBaseline) groups.push_back(s);
  }
  return groups;
}

// Mean over cells of the squared deviations from the cells' means, n - 1 in each.
double variance_within(const TeamPool& pool, const StudyOutcome& outcome, const std::vector<std::size_t>& strategies,
                       const std::vector<std::size_t>& compositions) {
  double sum = 0.0, df = 0.0;
  for (const auto s : strategies) {
    for (const auto c : compositions) {
      const auto cell = pool.cell(outcome, s, c);
      const double center = mean(cell);
      for (const double value : cell) sum += (value - center) * (value - center);
      df += static_cast<double>(cell.size() - 1);
    }
  }
  return sum / df;
}

std::vector<std::size_t> compositions_of(const TeamPool& pool, const Effect& effect) {
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < pool.compositions().size(); ++c) {
    if (effect.kind != Effect::Kind::kStrategyWithin || pool.compositions()[c] == effect.composition) all.push_back(c);
  }
  return all;
}

// What a term adds to the means of the effect's cells, row by row of the groups.
std::vector<double> term_effects(const std::vector<double>& means, std::size_t groups, Effect::Kind kind) {
  Factor group{"", std::vector<std::string>(groups), {}},
      composition{"", std::vector<std::string>(means.size() / groups), {}};
  for (std::size_t i = 0; i < means.size(); ++i) {
    group.codes.push_back(i / composition.levels.size());
    composition.codes.push_back(i % composition.levels.size());
  }
  const auto design = make_cell_design(means.size(), std::vector{group, composition}, {}).value();
  if (kind == Effect::Kind::kInteraction) return design.effect({0, 1}, means);
  return design.effect({kind == Effect::Kind::kComposition ? 1u : 0u}, means);
}

double mean_square(const std::vector<double>& effects) {
  return std::inner_product(effects.begin(), effects.end(), effects.begin(), 0.0) / static_cast<double>(effects.size());
}

std::vector<double> cell_means(const TeamPool& pool, const Effect& effect, const std::vector<std::size_t>& groups,
                               const std::vector<std::size_t>& compositions) {
  std::vector<double> means;
  for (const auto s : groups)
    for (const auto c : compositions) means.push_back(mean(pool.cell(*effect.outcome, s, c)));
  return means;
}

std::size_t term_df(const Effect& effect, std::size_t groups, std::size_t compositions) {
  switch (effect.kind) {
    case Effect::Kind::kComposition:
      return compositions - 1;
    case Effect::Kind::kInteraction:
      return (groups - 1) * (compositions - 1);
    default:
      return groups - 1;
  }
}

}  // namespace

// --- outcomes ---------------------------------------------------------------------

EffectData::EffectData(const TeamPool& pool, const Effect& effect) : num_compositions_{pool.compositions().size()} {
  for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
    for (std::size_t c = 0; c < num_compositions_; ++c) {
      cells_.push_back(pool.cell(*effect.outcome, s, c));
      mean_.push_back(mean(cells_.back()));
    }
  }
  shift_.assign(cells_.size(), 0.0);
  if (effect.imposed) impose(pool, effect);
}

void EffectData::impose(const TeamPool& pool, const Effect& effect) {
  for (std::size_t i = 0; i < shift_.size(); ++i) shift_[i] = -mean_[i];
  if (effect.kind == Effect::Kind::kContrast) {
    for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
      for (std::size_t c = 0; c < num_compositions_; ++c) {
        auto& shift = shift_[s * num_compositions_ + c];
        if (is_selected(pool, effect.first, s, c)) shift += *effect.imposed / 2.0;
        if (is_selected(pool, effect.second, s, c)) shift -= *effect.imposed / 2.0;
      }
    }
    return;
  }
  // The pattern of the pool's own means, or a ramp where they do not differ, at the size asked for.
  const auto groups = group_positions(pool);
  const auto compositions = compositions_of(pool, effect);
  auto effects = term_effects(cell_means(pool, effect, groups, compositions), groups.size(), effect.kind);
  const double variance = variance_within(pool, *effect.outcome, groups, compositions);
  if (mean_square(effects) <= 1e-24 * (variance + 1e-300)) {
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (std::size_t j = 0; j < compositions.size(); ++j)
        effects[i * compositions.size() + j] = (static_cast<double>(i) + 1.0) * (static_cast<double>(j) + 1.0);
    }
    effects = term_effects(effects, groups.size(), effect.kind);
  }
  const double wanted = variance * *effect.imposed / (1.0 - *effect.imposed);
  const double scale = std::sqrt(wanted / mean_square(effects));
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = 0; j < compositions.size(); ++j)
      shift_[groups[i] * num_compositions_ + compositions[j]] += scale * effects[i * compositions.size() + j];
  }
}

EffectCells effect_cells(const TeamPool& pool, const Effect& effect) {
  const auto& range = *effect.outcome;
  EffectCells result{.low = range.low, .high = range.high};
  const EffectData data{pool, effect};
  const auto term = cells_of(pool, effect);
  const auto is_about = [&](std::size_t s, std::size_t c) {
    if (effect.kind == Effect::Kind::kContrast)
      return is_selected(pool, effect.first, s, c) || is_selected(pool, effect.second, s, c);
    return std::find(term.groups.begin(), term.groups.end(), s) != term.groups.end() &&
           std::find(term.compositions.begin(), term.compositions.end(), c) != term.compositions.end();
  };
  double center = 0.0, variance = 0.0;
  std::vector<double> imposed;
  for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
    for (std::size_t c = 0; c < pool.compositions().size(); ++c) {
      if (!is_about(s, c)) continue;
      const auto cell = pool.cell(*effect.outcome, s, c);
      const double sd = standard_deviation(cell).value_or(0.0);
      result.cells.push_back({pool.strategies()[s], pool.compositions()[c], mean(cell), sd, std::nullopt});
      center += result.cells.back().mean;
      variance += sd * sd;
      imposed.push_back(data.cell_mean(s, c));
    }
  }
  const auto n = static_cast<double>(result.cells.size());
  result.sd = std::sqrt(variance / n);
  center /= n;
  const auto [least, most] = std::minmax_element(imposed.begin(), imposed.end());
  const double difference = *most - *least;
  result.largest_difference = difference == 0.0 ? 0.0 : difference / result.sd;
  if (!effect.imposed) return result;
  // Rounding of means is no reason to refuse an effect that just fits.
  const double slack = 1e-9 * std::max(1.0, std::abs(center));
  const double lowest = center + *least, highest = center + *most;
  for (std::size_t i = 0; i < imposed.size(); ++i) result.cells[i].imposed = center + imposed[i];
  if (lowest >= range.low - slack && highest <= range.high + slack) return result;
  const double room = std::min(
      {1.0, *least < 0.0 ? (center - range.low) / -*least : 1.0, *most > 0.0 ? (range.high - center) / *most : 1.0});
  result.impossible = fmt::format(
      "{} would have means from {:.4g} to {:.4g} around the simulated {:.4g}, but it lies {}; without moving that "
      "center, differences between means of up to {:.3g} are possible",
      range.column, lowest, highest, center,
      std::isinf(range.high) ? fmt::format("at {:g} or above", range.low)
                             : fmt::format("between {:g} and {:g}", range.low, range.high),
      std::max(0.0, room) * difference);
  return result;
}

// --- tests ------------------------------------------------------------------------

StudyTests::StudyTests(const TeamPool& pool, std::size_t teams, bool paired)
    : pool_{pool}, teams_{teams}, paired_{paired}, groups_{group_positions(pool)} {
  Factor strategy{columns::kStrategy, {}, {}}, composition{columns::kComposition, {}, {}};
  for (const auto s : groups_) strategy.levels.emplace_back(pool.strategies()[s]);
  composition.levels = pool.compositions();
  within_ = {columns::kStrategy, strategy.levels, {}};
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    within_.codes.insert(within_.codes.end(), teams, i);
    for (std::size_t c = 0; c < pool.compositions().size(); ++c) {
      strategy.codes.insert(strategy.codes.end(), teams, i);
      composition.codes.insert(composition.codes.end(), teams, c);
    }
  }
  const bool strategies = strategy.levels.size() > 1, compositions = composition.levels.size() > 1;
  if (strategies) {
    factors_.push_back(strategy);
    terms_.push_back({0});
    term_kinds_.push_back(0);
  }
  if (compositions) {
    terms_.push_back({factors_.size()});
    factors_.push_back(composition);
    term_kinds_.push_back(1);
  }
  if (strategies && compositions) {
    terms_.push_back({0, 1});
    term_kinds_.push_back(2);
  }
}

std::array<double, 3> StudyTests::two_way(const EffectData& data, const Draw& draw) const {
  const auto num_compositions = pool_.compositions().size();
  if (paired_) {
    std::vector<std::size_t> all(num_compositions);
    std::iota(all.begin(), all.end(), std::size_t{0});
    return within_people(all, data, draw);
  }
  std::vector<double> values;
  values.reserve(groups_.size() * num_compositions * teams_);
  for (const auto s : groups_) {
    for (std::size_t c = 0; c < num_compositions; ++c) {
      const auto& row = draw[s * num_compositions + c];
      for (std::size_t k = 0; k < teams_; ++k) values.push_back(data.at(s, c, row[k]));
    }
  }
  std::array<double, 3> p{1.0, 1.0, 1.0};
  if (terms_.empty()) return p;
  const auto table = anova(values, factors_, terms_);
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (table.terms[t].test) p[term_kinds_[t]] = table.terms[t].test->p;
  }
  return p;
}

namespace {

// p of an F test whose degrees of freedom are multiplied by epsilon; 1 without an error.
double f_test(double squares, double df, double error_squares, double error_df, double epsilon) {
  if (!(df > 0.0) || !(error_df > 0.0) || !(error_squares > 0.0)) return 1.0;
  const double f = (squares / df) / (error_squares / error_df);
  return f_upper(f, epsilon * df, epsilon * error_df);
}

}  // namespace

// People are blocks, nested in compositions; every block has each strategy once, so all terms are orthogonal.
std::array<double, 3> StudyTests::within_people(const std::vector<std::size_t>& compositions, const EffectData& data,
                                                const Draw& draw) const {
  Blocks blocks;
  std::vector<double> means;  // of the blocks
  for (std::size_t c = 0; c < compositions.size(); ++c) {
    for (std::size_t person = 0; person < teams_; ++person) {
      auto& row = blocks.rows.emplace_back();
      for (const auto s : groups_)
        row.push_back(data.at(s, compositions[c], draw[s * pool_.compositions().size() + compositions[c]][person]));
      means.push_back(subtract_mean(row));
      blocks.group.push_back(c);
    }
  }
  const auto spread = spread_of(blocks, compositions.size());
  const double epsilon = greenhouse_geisser(covariances_of(blocks, spread));
  const auto strategies = static_cast<double>(groups_.size()),
             num_compositions = static_cast<double>(compositions.size());
  const double error_df = (strategies - 1.0) * (static_cast<double>(means.size()) - num_compositions);
  const auto between = one_way_anova(means, {columns::kComposition, pool_.compositions(), blocks.group});
  return {
      f_test(spread.of_within, strategies - 1.0, spread.residual, error_df, epsilon), between ? between->p : 1.0,
      f_test(spread.of_interaction, (strategies - 1.0) * (num_compositions - 1.0), spread.residual, error_df, epsilon)};
}

double StudyTests::within(const Effect& effect, const EffectData& data, const Draw& draw) const {
  const auto& all = pool_.compositions();
  const auto c = static_cast<std::size_t>(std::find(all.begin(), all.end(), effect.composition) - all.begin());
  if (paired_) return std::min(1.0, within_people({c}, data, draw)[0] * static_cast<double>(all.size()));
  std::vector<double> values;
  for (const auto s : groups_) {
    const auto& row = draw[s * all.size() + c];
    for (std::size_t k = 0; k < teams_; ++k) values.push_back(data.at(s, c, row[k]));
  }
  const auto test = one_way_anova(values, within_);
  return test ? std::min(1.0, test->p * static_cast<double>(all.size())) : 1.0;
}

std::vector<double> StudyTests::outcomes(const TeamSelection& teams, const EffectData& data, const Draw& draw) const {
  const auto num_compositions = pool_.compositions().size();
  std::vector<double> values;
  for (std::size_t s = 0; s < pool_.strategies().size(); ++s) {
    for (std::size_t c = 0; c < num_compositions; ++c) {
      if (!is_selected(pool_, teams, s, c)) continue;
      const auto& row = draw[s * num_compositions + c];
      for (std::size_t k = 0; k < teams_; ++k) values.push_back(data.at(s, c, row[k]));
    }
  }
  return values;
}

std::vector<double> StudyTests::means_of_people(const TeamSelection& teams, const EffectData& data,
                                                const Draw& draw) const {
  const auto num_compositions = pool_.compositions().size();
  std::vector<double> means;
  for (std::size_t c = 0; c < num_compositions; ++c) {
    std::vector<double> sums(teams_, 0.0);
    double strategies = 0.0;
    for (std::size_t s = 0; s < pool_.strategies().size(); ++s) {
      if (!is_selected(pool_, teams, s, c)) continue;
      strategies += 1.0;
      for (std::size_t k = 0; k < teams_; ++k) sums[k] += data.at(s, c, draw[s * num_compositions + c][k]);
    }
    if (strategies == 0.0) continue;
    for (const double sum : sums) means.push_back(sum / strategies);
  }
  return means;
}

double StudyTests::contrast(const Effect& effect, const EffectData& data, const Draw& draw) const {
  if (!paired_) {
    const auto test = welch_t_test(outcomes(effect.first, data, draw), outcomes(effect.second, data, draw));
    return test ? test->test.p : 1.0;
  }
  const auto a = means_of_people(effect.first, data, draw), b = means_of_people(effect.second, data, draw);
  const bool same_people = effect.first.composition == effect.second.composition;
  const auto test = same_people ? paired_t_test(a, b) : welch_t_test(a, b);
  return test ? test->test.p : 1.0;
}

double StudyTests::p_value(const Effect& effect, const EffectData& data, const Draw& draw) const {
  switch (effect.kind) {
    case Effect::Kind::kStrategy:
    case Effect::Kind::kComposition:
    case Effect::Kind::kInteraction:
      return two_way(data, draw)[static_cast<std::size_t>(effect.kind)];
    case Effect::Kind::kStrategyWithin:
      return within(effect, data, draw);
    case Effect::Kind::kContrast:
      return contrast(effect, data, draw);
  }
  return 1.0;
}

// --- sizes ------------------------------------------------------------------------

double effect_size(const TeamPool& pool, const Effect& effect) {
  const auto groups = group_positions(pool);
  if (effect.kind == Effect::Kind::kContrast) {
    double sum[2] = {0.0, 0.0}, n[2] = {0.0, 0.0};
    for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
      for (std::size_t c = 0; c < pool.compositions().size(); ++c) {
        const double center = mean(pool.cell(*effect.outcome, s, c));
        for (const int side : {0, 1}) {
          if (!is_selected(pool, side == 0 ? effect.first : effect.second, s, c)) continue;
          sum[side] += center;
          n[side] += 1.0;
        }
      }
    }
    return sum[0] / n[0] - sum[1] / n[1];
  }
  const auto compositions = compositions_of(pool, effect);
  const auto effects = term_effects(cell_means(pool, effect, groups, compositions), groups.size(), effect.kind);
  const double variance = variance_within(pool, *effect.outcome, groups, compositions);
  // The cells' means vary by chance too: df * variance / (cells * replicates) of the mean square is noise.
  const auto df = static_cast<double>(term_df(effect, groups.size(), compositions.size()));
  const double noise = df * variance / static_cast<double>(effects.size() * pool.replicates());
  const double square = std::max(0.0, mean_square(effects) - noise);
  return variance > 0.0 ? square / (square + variance) : 0.0;
}

TermCells cells_of(const TeamPool& pool, const Effect& effect) {
  return {group_positions(pool), compositions_of(pool, effect)};
}

bool is_selected(const TeamPool& pool, const TeamSelection& teams, std::size_t strategy, std::size_t composition) {
  TeamAddress address;
  address.strategy = pool.strategies()[strategy];
  address.composition = pool.compositions()[composition];
  return teams.contains(address);
}

namespace {

// Mean and variance over the selected cells of the pool, cells of equal weight.
struct Spread {
  double variance = 0.0;
  double cells = 0.0;
};

Spread spread_of(const TeamPool& pool, const Effect& effect, const TeamSelection& teams) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  Spread spread;
  const EffectData data{pool, effect};
  for (std::size_t s = 0; s < pool.strategies().size(); ++s) {
    for (std::size_t c = 0; c < pool.compositions().size(); ++c) {
      if (!is_selected(pool, teams, s, c)) continue;
      spread.cells += 1.0;
      for (std::size_t r = 0; r < pool.replicates(); ++r) {
        const double value = data.at(s, c, r);
        sum += value;
        squares += value * value;
        n += 1.0;
      }
    }
  }
  spread.variance = (squares - sum * sum / n) / (n - 1.0);
  return spread;
}

}  // namespace

std::optional<double> analytic_power(const TeamPool& pool, const Effect& effect, double size, std::size_t teams,
                                     double alpha, bool paired) {
  if (paired) return std::nullopt;  // depends on the correlation within people
  const auto groups = group_positions(pool).size();
  const auto compositions = compositions_of(pool, effect).size();
  const auto n = static_cast<double>(teams);
  if (effect.kind == Effect::Kind::kContrast) {
    const auto a = spread_of(pool, effect, effect.first), b = spread_of(pool, effect, effect.second);
    const double va = a.variance / (n * a.cells), vb = b.variance / (n * b.cells);
    if (!(va + vb > 0.0)) return std::nullopt;
    const double df = (va + vb) * (va + vb) / (va * va / (n * a.cells - 1.0) + vb * vb / (n * b.cells - 1.0));
    return non_central_f_upper(f_quantile(1.0 - alpha, 1.0, df), 1.0, df, size * size / (va + vb));
  }
  if (effect.kind == Effect::Kind::kStrategyWithin) alpha /= static_cast<double>(pool.compositions().size());
  const auto cells = groups * compositions;
  return f_test_power(size, term_df(effect, groups, compositions), cells, cells * teams, alpha);
}

}  // namespace kith
