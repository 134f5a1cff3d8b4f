#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kith/analysis/findings.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/study/study.hpp"

namespace kith {

/// The outcomes of many teams in every cell of a design, one number per team and outcome: what studies are drawn from.
class TeamPool {
 public:
  /// A pool whose outcomes are all 0, spec.replicates in every cell; quantities of exams if the study has exams.
  [[nodiscard]] static TeamPool empty(const StudySpec& spec);
  /// Stores the outcomes of a team. @param position  0-based, in the order of the tables.
  void set(std::size_t position, const TeamRecord& team);
  /// All teams of pools of one design, cell by cell, in the order of the pools.
  /// @throws std::invalid_argument without pools or if their designs differ.
  [[nodiscard]] static TeamPool joined(std::span<const TeamPool> pools);
  /// A pool of given values of one outcome, the same for every outcome.
  /// @param values  shape [strategies][compositions][replicates].
  TeamPool(std::vector<std::string> strategies, std::vector<std::string> compositions,
           std::vector<std::vector<std::vector<double>>> values);

  [[nodiscard]] const std::vector<std::string>& strategies() const noexcept { return strategies_; }
  [[nodiscard]] const std::vector<std::string>& compositions() const noexcept { return compositions_; }
  [[nodiscard]] std::size_t replicates() const noexcept { return replicates_; }
  /// Outcomes of one cell, shape [replicates].
  /// @throws std::invalid_argument for an outcome of exams if the teams were not examined.
  [[nodiscard]] std::span<const double> cell(const StudyOutcome& outcome, std::size_t strategy,
                                             std::size_t composition) const;

 private:
  TeamPool() = default;

  std::vector<std::string> strategies_;
  std::vector<std::string> compositions_;
  std::size_t replicates_ = 0;
  std::vector<std::vector<double>> values_;  // [quantities][cells * replicates]
};

/// Whether so many teams of this study can be simulated at a time by simulate_pools() without running out of memory.
/// @param threads  0: as many as there are cores.
/// @throws kith::Error (kInfeasible, E1201) if not.
void require_pool_memory(const Study& study, std::size_t threads, std::size_t teams);

/// Simulates all teams of a study and keeps their outcomes only: 32 bytes a team, 56 with exams.
/// @return one pool per variant; nothing if on_progress stopped it.
/// @throws kith::Error as require_pool_memory().
[[nodiscard]] std::optional<std::vector<TeamPool>> simulate_pools(const Atlas& atlas, const Study& study,
                                                                  const RunOptions& options);

struct PowerOptions {
  std::vector<std::size_t> teams{5, 10, 15, 20, 30, 50, 100};  ///< Per cell; ascending, each >= 2.
  double alpha = 0.05;                                         ///< Level of the tests, in (0, 1).
  double target = 0.8;                                         ///< Power wanted, in (0, 1).
  std::size_t draws = 1'000;                                   ///< Studies drawn from the pool.
  /// Whether every strategy teaches the same people in a study; else each has teams of its own.
  bool paired = false;
  std::uint64_t seed = 1;
};

/// A cell that an effect is about, as simulated and as the effect makes it.
struct EffectCell {
  std::string strategy;
  std::string composition;
  double mean = 0.0;              ///< Of the pool.
  double sd = 0.0;                ///< Of the pool; an imposed effect keeps it.
  std::optional<double> imposed;  ///< The mean that an imposed effect gives the cell: around the mean of all of them.
};
struct EffectCells {
  std::vector<EffectCell> cells{};
  double low = 0.0, high = 0.0;  ///< What values the outcome can have.
  double sd = 0.0;               ///< Within cells, pooled.
  /// The largest difference between means as imposed, or as simulated; in units of sd, infinite if that is 0.
  double largest_difference = 0.0;
  /// Why no study can have the imposed effect, a sentence: a mean would lie where the outcome cannot.
  std::string impossible{};
};
/// What an effect does to the cells of a pool. Tests of an effect only see differences; the imposed means are those of
/// the same teams if the mean of all their cells stays what it is.
[[nodiscard]] EffectCells effect_cells(const TeamPool& pool, const Effect& effect);

/// Power at one size of the study.
struct PowerPoint {
  std::size_t teams = 0;  ///< Per cell.
  double power = 0.0;     ///< Share of the drawn studies in which the effect was significant.
  double low = 0.0;       ///< 95 % interval; holds the draws' and the pool's error.
  double high = 1.0;
  double pool_error = 0.0;               ///< Standard error from the finite pool alone.
  std::optional<double> analytic_power;  ///< By the non-central F distribution for the same effect.
};

/// Teams per cell that reach the power wanted. Without a value it is beyond the largest size tried.
struct TeamsNeeded {
  std::optional<double> estimate, low, high;
  std::optional<std::size_t> analytic;  ///< By the non-central F; missing if a million do not suffice.
};

struct PowerCurve {
  Effect effect;
  /// Partial eta squared, corrected for its bias, or for a contrast the difference, of the pool; or as imposed.
  double size = 0.0;
  std::vector<PowerPoint> points;
  TeamsNeeded needed;
};

/// How often studies of different sizes would show effects.
///
/// Each drawn study takes n teams per cell from the pool without replacement and is analysed as kith analyses studies:
/// two-way analysis of variance (type II) of the group strategies, one-way within a composition with Bonferroni,
/// Welch's t test of a contrast. If every strategy teaches the same people, strategy is a factor within people:
/// analysis of variance with people as blocks, degrees of freedom by Greenhouse and Geisser [greenhouse1959]; the
/// composition is tested on means over each group of people, and contrasts on differences (or, between compositions,
/// means) of the same people. A team is one observation; its members are never counted as independent.
/// An imposed effect is added to
/// the pool's residuals in place of what the cells differ by. Draws share teams, so that their mean is less certain
/// than its number of draws says: the pool's share of the variance is estimated by the infinitesimal jackknife of
/// subsampling with its Monte Carlo bias removed [wager2014], and bounded by n / N of the binomial one, N the pool's
/// teams per cell, which it cannot exceed [hoeffding1948]. The interval is Wilson's at the number of independent
/// studies of the same variance.
/// @throws std::invalid_argument for options out of range, or a pool with fewer than twice as many teams per cell as
/// the largest study.
[[nodiscard]] std::vector<PowerCurve> power_curves(const TeamPool& pool, std::span<const Effect> effects,
                                                   const PowerOptions& options);

/// What became of a published test when its study was repeated.
struct FindingOutcome {
  std::size_t significant = 0;   ///< Studies in which it was.
  double low = 0.0, high = 1.0;  ///< 95 % Wilson interval of the share.
  /// Power of a study of this size if the published effect, partial eta squared of its F, were the true one.
  std::optional<double> published_eta_squared, analytic_power;
  std::optional<PowerPoint> imposed_power;  ///< The same, imposed on simulated teams.
};

struct Replication {
  std::size_t studies = 0;
  std::vector<FindingOutcome> findings;  ///< In the order given.
  std::size_t all_agree = 0;             ///< Studies that show all findings as published.
  double mean_agreement = 0.0;           ///< Mean number of findings shown as published.
};

struct ReplicationOptions {
  std::size_t studies = 200;
  bool paired = false;  ///< Analyse strategies as taught to the same people, see power_curves().
  std::uint64_t seed = 1;
  std::size_t threads = 0;  ///< Changes the speed, never a result.
  std::function<bool(std::size_t done, std::size_t total)> on_progress{};
};

/// Runs a study again and again, each time with people of its own, and counts how often each published test comes out
/// as published. Teams per cell are those of the study.
/// @return nothing if on_progress stopped it.
[[nodiscard]] std::optional<Replication> replicate_findings(const Atlas& atlas, const StudySpec& spec,
                                                            std::span<const PublishedFinding> findings,
                                                            const ReplicationOptions& options);

}  // namespace kith
