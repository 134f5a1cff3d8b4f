#include "kith/explain/reason.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "kith/explain/words.hpp"

namespace kith {
namespace {

// One path's surplus, as deeds: "take 2 more steps", "stop at the charger".
struct Surplus {
  std::vector<std::string> costs, gains;

  [[nodiscard]] bool empty() const { return costs.empty() && gains.empty(); }
  // "take 2 more steps to stop at the charger".
  [[nodiscard]] std::string words() const {
    return listed(costs) + (costs.empty() || gains.empty() ? "" : " to ") + listed(gains);
  }
};

// Without a verb of its own something is accepted or chosen.
std::string deed(const Wording& wording, std::int64_t n, bool more, bool is_cost) {
  if (auto words = doing(wording, n, more); !words.empty()) return words;
  return (is_cost ? "accept " : "choose ") + (more ? times_more(wording, n) : times(wording, n));
}

// What `taken` has and `spared` has not.
std::string compared(const Domain& domain, const IntegerVector& own, const IntegerVector& other) {
  Surplus taken, spared;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto n = own[k] - other[k];
    if (n == 0) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    auto& side = n > 0 ? taken : spared;
    (is_cost ? side.costs : side.gains)
        .push_back(deed(domain.wording(k), std::abs(n), own[k] != 0 && other[k] != 0, is_cost));
  }

  if (sign_of_dot(domain.weights().integer, own - other) == 0) {
    if (spared.empty()) return "it may as well " + taken.words();
    return "it may as well " + (taken.empty() ? "not " + spared.words() : taken.words() + " as " + spared.words());
  }
  if (spared.empty()) {
    if (taken.gains.empty()) return "it would " + taken.words() + " for nothing";
    return "it will " + taken.words();
  }
  if (!taken.empty()) return "it would rather " + taken.words() + " than " + spared.words();
  if (spared.costs.empty()) return "it would not " + spared.words() + ", although that costs nothing";
  if (!spared.gains.empty()) return "it will not " + spared.words();
  return "it would rather not " + spared.costs.front() + (spared.costs.size() > 1 ? " or " + spared.costs.back() : "");
}

void check(const Domain& domain, const IntegerVector& robot, const IntegerVector& alternative) {
  const auto d = domain.num_features();
  if (robot.size() != d || alternative.size() != d) {
    throw std::invalid_argument{"choice_in_words: there must be one count per feature"};
  }
  if (robot == alternative) throw std::invalid_argument{"choice_in_words: the paths have the same features"};
  if (sign_of_dot(domain.weights().integer, robot - alternative) < 0) {
    throw std::invalid_argument{"choice_in_words: the alternative is worth more to the robot"};
  }
}

}  // namespace

std::string choice_in_words(const Domain& domain, const IntegerVector& robot, const IntegerVector& alternative) {
  check(domain, robot, alternative);
  const auto difference = robot - alternative;
  const auto things = std::count_if(difference.begin(), difference.end(), [](std::int64_t n) { return n != 0; });
  if (things > static_cast<std::ptrdiff_t>(kMostThings)) return kAllInAll;
  auto sentence = compared(domain, robot, alternative);
  return std::count(sentence.begin(), sentence.end(), ' ') < kMostWords ? sentence : kAllInAll;
}

std::string prediction_in_words(const Domain& domain, const IntegerVector& predicted, const IntegerVector& robot) {
  check(domain, robot, predicted);
  return compared(domain, predicted, robot);
}

HalfSpace constraint_of(const IntegerVector& robot, const IntegerVector& alternative) {
  return HalfSpace{robot - alternative};
}

std::string explained(const std::string& choice, const std::string& fact) {
  if (fact.empty()) return choice;
  return choice == kAllInAll ? fact : choice + ": " + fact;
}

std::string reason(const Domain& domain, const IntegerVector& robot, const IntegerVector& alternative) {
  const auto choice = choice_in_words(domain, robot, alternative);
  return explained(choice, told(domain, constraint_of(robot, alternative)));
}

}  // namespace kith
