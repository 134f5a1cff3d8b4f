#include "kith/fit/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "kith/core/error.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

constexpr int kHalfNodes = 30;
constexpr double kReach = 5.0;  // the nodes span this many standard deviations to each side
constexpr double kDifficultySd = 3.0;

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

// Sparse answers: per person the (item, correct) pairs.
struct ItemAnswer {
  std::size_t item;
  bool correct;
};

class RaschFit {
 public:
  explicit RaschFit(const std::vector<AccuracyRecord>& records) {
    std::map<std::string, std::size_t> people;
    std::map<std::string, std::size_t> items;
    for (const auto& record : records) {
      const auto p = people.try_emplace(record.person, people.size()).first->second;
      const auto i = items.try_emplace(record.item, items.size()).first->second;
      if (p == answers_.size()) {
        answers_.emplace_back();
        fit_.people.push_back({.id = record.person});
      }
      if (i == fit_.items.size()) fit_.items.push_back({.id = record.item});
      answers_[p].push_back({i, record.correct});
      ++fit_.people[p].answered;
      ++fit_.items[i].answered;
      fit_.people[p].correct += record.correct ? 1u : 0u;
      fit_.items[i].correct += record.correct ? 1u : 0u;
    }
    for (int k = -kHalfNodes; k <= kHalfNodes; ++k) nodes_.push_back(kReach * k / kHalfNodes);
  }

  AccuracyFit run() {
    fit_.ability_sd = 1.0;
    for (int round = 0; round < 300; ++round) {
      weigh();
      const double moved = update_difficulties();
      const double sd = new_sd();
      const double change = std::max(moved, std::abs(sd - fit_.ability_sd));
      fit_.ability_sd = sd;
      if (change < 1e-6) break;
    }
    weigh();
    describe_people();
    return std::move(fit_);
  }

 private:
  // Posterior masses of the nodes for every person.
  void weigh() {
    masses_.assign(answers_.size(), {});
    for (std::size_t p = 0; p < answers_.size(); ++p) {
      std::vector<double> logs;
      for (const double z : nodes_) {
        double sum = -0.5 * z * z;
        for (const auto& answer : answers_[p]) {
          const double x = fit_.ability_sd * z - fit_.items[answer.item].difficulty;
          sum -= std::log1p(std::exp(answer.correct ? -x : x));
        }
        logs.push_back(sum);
      }
      const double top = *std::max_element(logs.begin(), logs.end());
      double total = 0.0;
      for (double& value : logs) total += value = std::exp(value - top);
      for (double& value : logs) value /= total;
      masses_[p] = std::move(logs);
    }
  }

  // One step of Newton per question; the largest move.
  double update_difficulties() {
    std::vector<double> slope(fit_.items.size());
    std::vector<double> curvature(fit_.items.size(), 1.0 / (kDifficultySd * kDifficultySd));
    for (std::size_t i = 0; i < slope.size(); ++i) {
      slope[i] = -fit_.items[i].difficulty / (kDifficultySd * kDifficultySd);
    }
    for (std::size_t p = 0; p < answers_.size(); ++p) {
      for (const auto& answer : answers_[p]) {
        for (std::size_t k = 0; k < nodes_.size(); ++k) {
          const double right = logistic(fit_.ability_sd * nodes_[k] - fit_.items[answer.item].difficulty);
          slope[answer.item] += masses_[p][k] * (right - (answer.correct ? 1.0 : 0.0));
          curvature[answer.item] += masses_[p][k] * right * (1.0 - right);
        }
      }
    }
    double largest = 0.0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
      const double move = std::clamp(slope[i] / curvature[i], -1.0, 1.0);
      fit_.items[i].difficulty += move;
      largest = std::max(largest, std::abs(move));
    }
    return largest;
  }

  [[nodiscard]] double moment(std::size_t p, int power) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < nodes_.size(); ++k) sum += masses_[p][k] * std::pow(fit_.ability_sd * nodes_[k], power);
    return sum;
  }

  [[nodiscard]] double new_sd() const {
    double sum = 0.0;
    for (std::size_t p = 0; p < answers_.size(); ++p) sum += moment(p, 2);
    return std::max(std::sqrt(sum / static_cast<double>(answers_.size())), 1e-4);
  }

  void describe_people() {
    double error = 0.0;
    for (std::size_t p = 0; p < answers_.size(); ++p) {
      auto& person = fit_.people[p];
      person.ability = moment(p, 1);
      person.sd = std::sqrt(std::max(moment(p, 2) - person.ability * person.ability, 0.0));
      person.lower = quantile(p, 0.025);
      person.upper = quantile(p, 0.975);
      error += person.sd * person.sd / static_cast<double>(answers_.size());
    }
    fit_.reliability = std::clamp(1.0 - error / (fit_.ability_sd * fit_.ability_sd), 0.0, 1.0);
  }

  // Uniform within the cells about the nodes.
  [[nodiscard]] double quantile(std::size_t p, double probability) const {
    const double width = nodes_[1] - nodes_[0];
    double below = 0.0;
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const double mass = masses_[p][k];
      if (below + mass >= probability && mass > 0.0) {
        return fit_.ability_sd * (nodes_[k] + width * ((probability - below) / mass - 0.5));
      }
      below += mass;
    }
    return fit_.ability_sd * nodes_.back();
  }

  std::vector<std::vector<ItemAnswer>> answers_;
  std::vector<double> nodes_;  // in standard deviations
  std::vector<std::vector<double>> masses_;
  AccuracyFit fit_;
};

}  // namespace

AccuracyFit fit_accuracy(const std::vector<AccuracyRecord>& records) {
  const bool one_item = std::all_of(records.begin(), records.end(),
                                    [&](const AccuracyRecord& record) { return record.item == records.front().item; });
  const bool one_person = std::all_of(records.begin(), records.end(), [&](const AccuracyRecord& record) {
    return record.person == records.front().person;
  });
  if (one_item || one_person) {
    auto diagnostic = detail::fault("E0710", "at least two people and two questions are needed", "", 0);
    diagnostic.infeasible = true;
    throw Error{{diagnostic}};
  }
  return RaschFit{records}.run();
}

std::vector<AccuracyRecord> accuracy_records(const std::vector<RecordedResponse>& responses) {
  std::vector<AccuracyRecord> records;
  for (const auto& response : responses) {
    records.push_back({std::to_string(response.experiment) + "/" + std::to_string(response.participant), response.world,
                       response.optimal});
  }
  return records;
}

}  // namespace kith
