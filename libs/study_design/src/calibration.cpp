#include "kith/study_design/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "evaluation.hpp"
#include "frontier.hpp"
#include "kith/stats/distributions.hpp"
#include "kith/study_design/space_filling.hpp"
#include "minimize.hpp"
#include "misfit.hpp"
#include "surfaces.hpp"

namespace kith {
namespace {

constexpr double kNoWorse = 1.0;  // a loss of misfit that is worth fewer changes: a parameter within its standard error
constexpr double kLittle = 0.1;   // a loss that is worth fewer digits
constexpr double kLeastDegrees = 0.5;

// The last design decides: it gets the teams in full, each one before half as many.
std::size_t teams_in_round(const CalibrationOptions& options, std::size_t round) {
  return std::max<std::size_t>(2, options.teams >> (options.rounds - 1 - round));
}

class Calibrator {
 public:
  Calibrator(const Atlas& atlas, const StudyMaker& make_study, const TargetSet& set, const CalibrationOptions& options)
      : set_{set}, options_{options}, random_{options.seed}, lab_{atlas, make_study, set, options} {
    for (const auto& parameter : set.parameters) present_.push_back(parameter.present);
    lab_.expect(lab_.cost(1, most_teams_per_cell(options)));
  }

  std::optional<Calibration> run() {
    auto box = Box::whole(present_.size());
    for (std::size_t round = 0; round < options_.rounds; ++round) {
      if (!design(box, round)) return std::nullopt;
      surfaces_.emplace(fit_in(box));
      estimate(round);
      if (round == 0) describe_sensitivities();
      if (round + 1 < options_.rounds) box = smaller(box, round);
    }
    if (!confirm(box) || !explore_frontier()) return std::nullopt;
    // The answer was confirmed to do as well as the best, whatever the quadratics say of it, and it is rounded.
    for (std::size_t k = 0; k < result_.ranges.size(); ++k) {
      result_.ranges[k].low = std::min(result_.ranges[k].low, result_.best.values[k]);
      result_.ranges[k].high = std::max(result_.ranges[k].high, result_.best.values[k]);
    }
    result_.teams_simulated = lab_.done();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::size_t frontier_teams() const { return std::max<std::size_t>(2, options_.confirm_teams / 2); }
  [[nodiscard]] std::size_t teams_in(std::size_t round) const { return teams_in_round(options_, round); }
  [[nodiscard]] RandomStream stream(std::string_view purpose, std::size_t number = 0) const {
    return random_.split(purpose).split(number);
  }

  // Places a design in the box and simulates it; all designs share their people and chance.
  bool design(const Box& box, std::size_t round) {
    constexpr std::size_t kTries = 20;
    std::vector<std::vector<double>> settings;
    for (const auto& fraction : latin_hypercube(options_.points, present_.size(), kTries, stream("design", round))) {
      units_.push_back(box.place(fraction));
      settings.push_back(to_values(set_.parameters, units_.back()));
    }
    const auto evaluations = lab_.run(settings, teams_in(round), random_.split("search").address());
    if (!evaluations) return false;
    evaluations_.insert(evaluations_.end(), evaluations->begin(), evaluations->end());
    return true;
  }

  // From the points in the box and a little around it.
  [[nodiscard]] Surfaces fit_in(const Box& box) const {
    constexpr double kMargin = 0.25;
    std::vector<std::vector<double>> points;
    std::vector<Evaluation> evaluations;
    for (std::size_t i = 0; i < units_.size(); ++i) {
      if (!box.contains(units_[i], kMargin)) continue;
      points.push_back(units_[i]);
      evaluations.push_back(evaluations_[i]);
    }
    return {set_.targets, box, points, evaluations};
  }

  // The discrepancy that the surfaces leave, and the misfit that follows.
  void estimate(std::size_t number) {
    estimate_ = estimate_discrepancy(*surfaces_, stream("discrepancy", number));
    misfit_.emplace(*surfaces_, estimate_.discrepancy);
  }

  // Around the settings that may still be the best, at least a quarter as wide as before, and a little beyond.
  [[nodiscard]] Box smaller(const Box& box, std::size_t round) const {
    constexpr std::size_t kSample = 8192;
    const double possible = std::max(12.0, 2.0 * significant_loss(estimate_));  // more than intervals need
    const Objective misfit = [&](std::span<const double> unit) { return misfit_->at(unit); };
    auto sample = ranked_sample(misfit, box, Fixed(present_.size()), kSample, stream("shrink", round));
    const double limit = misfit_->at(estimate_.unit) + possible;
    const auto num_possible =
        std::count_if(sample.begin(), sample.end(), [&](const SamplePoint& one) { return one.value <= limit; });
    sample.resize(std::max(kSample / 50, static_cast<std::size_t>(num_possible)));
    Box next = box;
    for (std::size_t k = 0; k < present_.size(); ++k) {
      std::vector<double> coordinates;
      for (const auto& drawn : sample) coordinates.push_back(drawn.unit[k]);
      std::sort(coordinates.begin(), coordinates.end());
      const auto quantile = [&](double q) {
        return coordinates[static_cast<std::size_t>(q * static_cast<double>(coordinates.size() - 1))];
      };
      const double before = box.high[k] - box.low[k];
      const double low = quantile(0.01), high = quantile(0.99);
      const double half = std::max((high - low) / 2.0 + 0.05 * before, before / 8.0);
      next.low[k] = std::clamp((low + high) / 2.0 - half, 0.0, 1.0);
      next.high[k] = std::clamp((low + high) / 2.0 + half, 0.0, 1.0);
    }
    return next;
  }

  void describe_sensitivities() {
    for (std::size_t t = 0; t < set_.targets.size(); ++t) {
      const auto& surface = surfaces_->surface(t);
      std::vector<Sensitivity> row;
      const double unit = set_.targets[t].is_factor ? set_.targets[t].value : 1.0;
      for (std::size_t k = 0; k < present_.size(); ++k)
        row.push_back({surface.main_share(k), surface.total_share(k), unit * surface.slope(k)});
      result_.sensitivities.push_back(std::move(row));
      result_.sensitivity_explained.push_back(surface.explained());
    }
  }

  // --- candidates --------------------------------------------------------------

  // As many parameters as possible as the study has them, the others moved to where that costs least.
  [[nodiscard]] std::vector<double> frugal(const Box& box, const std::vector<double>& best) const {
    const auto present = to_unit(set_.parameters, present_);
    Fixed fixed(present_.size());
    auto point = best;
    while (true) {
      std::optional<std::size_t> cheapest;
      std::vector<double> cheapest_point;
      double cheapest_value = misfit_->at(best) + kNoWorse;
      for (std::size_t k = 0; k < present_.size(); ++k) {
        if (fixed[k] || present[k] < box.low[k] || present[k] > box.high[k]) continue;
        auto trial = fixed;
        trial[k] = present[k];
        const auto there = misfit_->minimum(trial, stream("frugal", k));
        const double value = misfit_->at(there);
        if (value > cheapest_value) continue;
        cheapest = k;
        cheapest_point = there;
        cheapest_value = value;
      }
      if (!cheapest) return point;
      fixed[*cheapest] = present[*cheapest];
      point = cheapest_point;
    }
  }

  void find_ranges(const Box& box) {
    const auto& best = estimate_.unit;
    const double limit = misfit_->at(best) + significant_loss(estimate_);
    constexpr double kEdge = 1e-9;
    for (std::size_t k = 0; k < best.size(); ++k) {
      const auto interval = profile_interval(*misfit_, box, best, k, limit);
      auto low = best, high = best;
      low[k] = interval.low;
      high[k] = interval.high;
      const auto& parameter = set_.parameters[k];
      ParameterRange range{to_values(set_.parameters, low)[k], to_values(set_.parameters, high)[k],
                           interval.reaches_low, interval.reaches_high};
      if (interval.reaches_low && box.low[k] <= kEdge) range.low = parameter.min;
      if (interval.reaches_high && box.high[k] >= 1.0 - kEdge) range.high = parameter.max;
      result_.ranges.push_back(range);
    }
  }

  // How far one parameter alone may move from a point at little loss, in its own unit.
  [[nodiscard]] double free_width(const Box& box, const std::vector<double>& unit, std::size_t k) const {
    constexpr std::size_t kSteps = 200;
    const double limit = misfit_->at(unit) + kLittle;
    auto low = unit, high = unit;
    for (std::size_t i = 0; i <= kSteps; ++i) {
      auto point = unit;
      point[k] = box.low[k] + (box.high[k] - box.low[k]) * static_cast<double>(i) / static_cast<double>(kSteps);
      if (misfit_->at(point) > limit) continue;
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
    return to_values(set_.parameters, high)[k] - to_values(set_.parameters, low)[k];
  }

  // Numbers that people can read: no more digits than matter; what the study has stays as it is.
  [[nodiscard]] std::vector<double> readable(const Box& box, const std::vector<double>& unit) const {
    auto values = to_values(set_.parameters, unit);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto& parameter = set_.parameters[k];
      if (std::abs(values[k] - present_[k]) <= 1e-9 * std::abs(present_[k])) {
        values[k] = present_[k];
      } else {
        const double width = free_width(box, unit, k);
        values[k] = std::clamp(rounded(values[k], 0.0, width, parameter.integer), parameter.min, parameter.max);
      }
    }
    return values;
  }

  [[nodiscard]] std::vector<double> best_simulated() const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < evaluations_.size(); ++i) {
      const double value = misfit_->of(misses_of(set_.targets, evaluations_[i].figures));
      if (value < least) {
        least = value;
        best = i;
      }
    }
    return units_[best];
  }

  // Simulates candidates anew. All share their people and chance with each other, not with the designs.
  bool confirm_some(const std::vector<std::pair<std::string, std::vector<double>>>& proposals) {
    std::vector<std::vector<double>> settings;
    std::vector<std::string> labels;
    for (const auto& proposal : proposals) {
      const auto& values = proposal.second;
      const auto known = [&](const CalibrationPoint& one) { return one.values == values; };
      const auto& confirmed = result_.candidates;
      if (std::any_of(confirmed.begin(), confirmed.end(), known)) continue;
      if (std::find(settings.begin(), settings.end(), values) != settings.end()) continue;
      settings.push_back(values);
      labels.push_back(proposal.first);
    }
    if (settings.empty()) return true;
    const auto evaluations = lab_.run(settings, options_.confirm_teams, random_.split("confirm").address());
    if (!evaluations) return false;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      result_.candidates.push_back(point_of(set_.targets, (*evaluations)[i], settings[i], labels[i]));
      confirmed_.push_back((*evaluations)[i]);
    }
    return true;
  }

  // @pre these values were confirmed.
  [[nodiscard]] const Evaluation& confirmed_at(const std::vector<double>& values) const {
    std::size_t i = 0;
    while (result_.candidates[i].values != values) ++i;
    return confirmed_[i];
  }

  // The designs share their people, so all figures are off alike: the surfaces are moved to what more teams say at the
  // minimum, and the minimum is looked for again; twice, because it may move.
  bool confirm(const Box& box) {
    const auto first_values = readable(box, estimate_.unit);
    lab_.expect(lab_.done() + lab_.cost(5, options_.confirm_teams) +
                lab_.cost(options_.frontier_points, frontier_teams()));
    if (!confirm_some({{"the study as it is", present_},
                       {"best simulated", readable(box, best_simulated())},
                       {"first minimum", first_values}}))
      return false;
    correct(first_values, 0);
    const auto values = readable(box, estimate_.unit);
    if (!confirm_some({{"fewest changes", readable(box, frugal(box, estimate_.unit))}, {"minimum", values}}))
      return false;
    correct(values, 1);
    find_ranges(box);
    for (std::size_t i = 0; i < confirmed_.size(); ++i)
      result_.candidates[i].misfit = misfit_->of(misses_of(set_.targets, confirmed_[i].figures));
    choose();
    for (std::size_t t = 0; t < set_.targets.size(); ++t) {
      result_.surface_error.push_back(surfaces_->error_of(t));
      result_.explained.push_back(surfaces_->surface(t).explained());
    }
    result_.discrepancy = estimate_.discrepancy;
    result_.least_misfit = estimate_.misfit;
    result_.degrees_of_freedom = estimate_.degrees_of_freedom;
    if (estimate_.degrees_of_freedom >= kLeastDegrees)
      result_.misfit_p = chi_squared_upper(estimate_.misfit, estimate_.degrees_of_freedom);
    return true;
  }

  void correct(const std::vector<double>& values, std::size_t number) {
    surfaces_->correct(to_unit(set_.parameters, values), confirmed_at(values));
    estimate(options_.rounds + number);
  }

  [[nodiscard]] std::size_t changes(const CalibrationPoint& point) const {
    std::size_t n = 0;
    for (std::size_t k = 0; k < present_.size(); ++k) n += point.values[k] != present_[k] ? 1u : 0u;
    return n;
  }

  [[nodiscard]] static std::ptrdiff_t missed(const CalibrationPoint& point) {
    return std::count_if(point.targets.begin(), point.targets.end(),
                         [](const TargetOutcome& one) { return std::abs(one.miss) > 1.0; });
  }

  // Of those about as good as the best that miss no more tolerances, the one that changes least.
  void choose() {
    const auto& all = result_.candidates;
    std::size_t least = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].misfit < all[least].misfit) least = i;
    }
    auto chosen = least;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool as_good = all[i].misfit - all[least].misfit <= kNoWorse && missed(all[i]) <= missed(all[least]);
      if (as_good && changes(all[i]) < changes(all[chosen])) chosen = i;
    }
    result_.best = all[chosen];
  }

  // --- what cannot be met together ----------------------------------------------

  bool explore_frontier() {
    Surfaces global{set_.targets, Box::whole(present_.size()), units_, evaluations_};
    global.correct(to_unit(set_.parameters, result_.best.values), confirmed_at(result_.best.values));
    result_.conflicts = find_conflicts(set_.targets, global, stream("conflicts"));
    const auto quantities = trade_off(set_.targets);
    if (!quantities || options_.frontier_points == 0) return true;
    result_.first_quantity = quantities->first;
    result_.second_quantity = quantities->second;
    const auto settings = frontier_settings(set_, global, *quantities, options_.frontier_points, stream("frontier"));
    const auto evaluations = lab_.run(settings, frontier_teams(), random_.split("confirm").address());
    if (!evaluations) return false;
    std::vector<CalibrationPoint> points{result_.candidates};
    for (std::size_t i = 0; i < settings.size(); ++i) {
      points.push_back(point_of(set_.targets, (*evaluations)[i], settings[i], "on the frontier"));
      points.back().misfit = misfit_->of(misses_of(set_.targets, (*evaluations)[i].figures));
    }
    result_.frontier = not_dominated(set_.targets, std::move(points), *quantities);
    return true;
  }

  const TargetSet& set_;
  const CalibrationOptions& options_;
  RandomStream random_;
  Laboratory lab_;
  std::vector<double> present_;
  std::vector<std::vector<double>> units_;  // of all settings simulated in the search
  std::vector<Evaluation> evaluations_;
  std::vector<Evaluation> confirmed_;  // of the candidates
  std::optional<Surfaces> surfaces_;   // of the last box
  std::optional<Misfit> misfit_;       // by these surfaces
  DiscrepancyEstimate estimate_;
  Calibration result_;
};

}  // namespace

std::size_t most_teams_per_cell(const CalibrationOptions& options) {
  std::size_t teams = 0;
  for (std::size_t round = 0; round < options.rounds; ++round) teams += options.points * teams_in_round(options, round);
  return teams + 5 * options.confirm_teams +
         options.frontier_points * std::max<std::size_t>(2, options.confirm_teams / 2);
}

std::optional<Calibration> calibrate(const Atlas& atlas, const StudyMaker& make_study, const TargetSet& targets,
                                     const CalibrationOptions& options) {
  if (targets.targets.empty() || targets.parameters.empty())
    throw std::invalid_argument{"calibrate: needs a target and a parameter"};
  if (options.rounds < 1 || options.points < 8 || options.teams < 2 || options.confirm_teams < 2)
    throw std::invalid_argument{"calibrate: too few rounds, points or teams"};
  return Calibrator{atlas, make_study, targets, options}.run();
}

}  // namespace kith
