// Set cover over state-action demonstrations, as Brown and Niekum (2019) do it, in double precision.
#include "kith/bec/state_action_cover.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kith {
namespace {

constexpr double kSame = 1e-6;

// The distance of a target from the cone of some columns: the least squares problem with weights >= 0, by the active
// set method of [lawson1974].
class DistanceFromCone {
 public:
  DistanceFromCone(const Eigen::MatrixXd& columns, const std::vector<std::size_t>& used, const Eigen::VectorXd& target)
      : columns_{columns}, used_{used}, target_{target}, rest_{target} {}

  [[nodiscard]] double value(double tolerance) {
    const std::size_t most_steps = 3 * used_.size() + 10;
    for (std::size_t step = 0; step < most_steps && rest_.norm() > tolerance; ++step) {
      std::size_t best = 0;
      double most = kNoGain;
      for (const auto column : used_) {
        const double gain = columns_.col(static_cast<Eigen::Index>(column)).dot(rest_);
        if (gain <= most || std::find(active_.begin(), active_.end(), column) != active_.end()) continue;
        most = gain;
        best = column;
      }
      if (most <= kNoGain) break;
      active_.push_back(best);
      weights_.conservativeResize(static_cast<Eigen::Index>(active_.size()));
      weights_[weights_.size() - 1] = 0.0;
      fit();
    }
    return rest_.norm();
  }

 private:
  static constexpr double kNoGain = 1e-12;

  // Least squares with the active columns; those whose weight would become negative leave.
  void fit() {
    while (!active_.empty()) {
      Eigen::MatrixXd matrix(columns_.rows(), static_cast<Eigen::Index>(active_.size()));
      for (std::size_t i = 0; i < active_.size(); ++i) {
        matrix.col(static_cast<Eigen::Index>(i)) = columns_.col(static_cast<Eigen::Index>(active_[i]));
      }
      const Eigen::VectorXd wanted = matrix.colPivHouseholderQr().solve(target_);
      double part = 1.0;
      for (Eigen::Index i = 0; i < wanted.size(); ++i) {
        if (wanted[i] <= 0.0) part = std::min(part, weights_[i] / (weights_[i] - wanted[i]));
      }
      if (wanted.minCoeff() > 0.0) {
        weights_ = wanted;
        rest_ = target_ - matrix * weights_;
        return;
      }
      weights_ += part * (wanted - weights_);
      drop(wanted);
    }
    rest_ = target_;
  }

  void drop(const Eigen::VectorXd& wanted) {
    constexpr double kZero = 1e-14;
    std::vector<std::size_t> kept;
    Eigen::VectorXd weights(weights_.size());
    Eigen::Index n = 0;
    for (std::size_t i = 0; i < active_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (wanted[at] <= 0.0 && weights_[at] <= kZero) continue;
      kept.push_back(active_[i]);
      weights[n++] = weights_[at];
    }
    if (kept.size() == active_.size()) {  // rounding: the last to come leaves
      kept.pop_back();
      --n;
    }
    active_ = std::move(kept);
    weights_ = weights.head(n);
  }

  const Eigen::MatrixXd& columns_;
  const std::vector<std::size_t>& used_;
  const Eigen::VectorXd& target_;
  Eigen::VectorXd rest_;
  std::vector<std::size_t> active_;
  Eigen::VectorXd weights_;
};

Eigen::MatrixXd chosen(const Eigen::MatrixXd& all, const std::vector<std::size_t>& which) {
  Eigen::MatrixXd result(all.rows(), static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) {
    result.col(static_cast<Eigen::Index>(i)) = all.col(static_cast<Eigen::Index>(which[i]));
  }
  return result;
}

// Unit normals without duplicates, and which of them every candidate conveys.
class Comparisons {
 public:
  Comparisons(const Mdp& mdp, const Behaviour& robot, std::span<const StateIndex> candidates)
      : mdp_{mdp}, robot_{robot}, normals_(static_cast<Eigen::Index>(mdp.num_features()), 0) {
    for (const auto s : candidates) {
      auto& conveyed = by_state_.emplace_back();
      const auto choices = mdp.choices(s);
      const Eigen::VectorXd own = counts(choices[robot.choice[s.value()]]);
      for (std::size_t c = 0; c < choices.size(); ++c) {
        if (c == robot.choice[s.value()]) continue;
        const Eigen::VectorXd difference = own - counts(choices[c]);
        const double length = difference.norm();
        if (length < kSame) continue;  // the same features
        conveyed.push_back(number_of(difference / length));
      }
    }
  }

  [[nodiscard]] const Eigen::MatrixXd& normals() const { return normals_; }
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& by_state() const { return by_state_; }

 private:
  // mu(s, b)
  [[nodiscard]] Eigen::VectorXd counts(const Choice& choice) const {
    const auto d = static_cast<Eigen::Index>(mdp_.num_features());
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(d);
    for (const auto& outcome : mdp_.outcomes(choice)) {
      const auto features = mdp_.features(outcome);
      const auto& later = robot_.counts[outcome.next.value()];
      for (Eigen::Index k = 0; k < d; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const double after =
            static_cast<double>(later[at]) / static_cast<double>(StateActionCover::kScale) * mdp_.discount();
        sum[k] += outcome.probability * (features[at] + after);
      }
    }
    return sum;
  }

  std::size_t number_of(const Eigen::VectorXd& normal) {
    for (Eigen::Index i = 0; i < normals_.cols(); ++i) {
      if ((normals_.col(i) - normal).cwiseAbs().maxCoeff() < kSame) return static_cast<std::size_t>(i);
    }
    normals_.conservativeResize(Eigen::NoChange, normals_.cols() + 1);
    normals_.col(normals_.cols() - 1) = normal;
    return static_cast<std::size_t>(normals_.cols() - 1);
  }

  const Mdp& mdp_;
  const Behaviour& robot_;
  Eigen::MatrixXd normals_;
  std::vector<std::vector<std::size_t>> by_state_;
};

}  // namespace

std::vector<std::size_t> irredundant_normals(const Eigen::MatrixXd& normals, double tolerance) {
  std::vector<std::size_t> left(static_cast<std::size_t>(normals.cols()));
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  for (std::size_t i = 0; i < static_cast<std::size_t>(normals.cols()); ++i) {
    std::vector<std::size_t> others;
    std::copy_if(left.begin(), left.end(), std::back_inserter(others), [&](std::size_t j) { return j != i; });
    const Eigen::VectorXd target = normals.col(static_cast<Eigen::Index>(i));
    if (DistanceFromCone{normals, others, target}.value(tolerance) <= tolerance) left = std::move(others);
  }
  return left;
}

std::optional<StateActionCover> cover_state_actions(const Mdp& mdp, std::span<const double> weights,
                                                    std::span<const StateIndex> candidates) {
  if (std::any_of(candidates.begin(), candidates.end(), [&](StateIndex s) { return mdp.is_terminal(s); })) {
    throw std::invalid_argument{"cover_state_actions: nothing is done in a terminal state"};
  }
  auto robot = behave(mdp, weights, {.scale = StateActionCover::kScale});
  if (!robot) return std::nullopt;
  const Comparisons comparisons{mdp, *robot, candidates};
  const auto facets = irredundant_normals(comparisons.normals());
  std::vector<bool> is_open(static_cast<std::size_t>(comparisons.normals().cols()), false);
  for (const auto facet : facets) is_open[facet] = true;

  StateActionCover result;
  std::vector<std::size_t> shown;
  for (;;) {
    std::size_t best = 0, most = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const auto& conveyed = comparisons.by_state()[i];
      std::size_t n = 0;
      for (std::size_t j = 0; j < conveyed.size(); ++j) {
        const bool is_first = std::find(conveyed.begin(), conveyed.begin() + static_cast<std::ptrdiff_t>(j),
                                        conveyed[j]) == conveyed.begin() + static_cast<std::ptrdiff_t>(j);
        n += is_open[conveyed[j]] && is_first ? 1U : 0U;
      }
      if (n <= most) continue;
      most = n;
      best = i;
    }
    if (most == 0) break;
    result.states.push_back(candidates[best]);
    for (const auto normal : comparisons.by_state()[best]) {
      is_open[normal] = false;
      if (std::find(shown.begin(), shown.end(), normal) == shown.end()) shown.push_back(normal);
    }
  }
  result.facets = chosen(comparisons.normals(), facets);
  result.conveyed = chosen(comparisons.normals(), shown);
  result.num_comparisons = static_cast<std::size_t>(comparisons.normals().cols());
  result.robot = *std::move(robot);
  return result;
}

}  // namespace kith
