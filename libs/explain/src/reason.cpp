#include "kith/explain/reason.hpp"

#include <stdexcept>
#include <vector>

#include "kith/explain/words.hpp"

namespace kith {
namespace {

// What one path has of a feature beyond the other path.
struct Surplus {
  std::size_t feature = 0;
  std::int64_t n = 0;
  bool more = false;  // the other path has some, too
};

// One path's surplus by what it is to the robot.
struct Difference {
  std::vector<Surplus> costs, gains;
  [[nodiscard]] bool empty() const { return costs.empty() && gains.empty(); }
};

// Sentences for one comparison, in verbs or in nouns.
class Comparison {
 public:
  Comparison(const Domain& domain, const IntegerVector& robot, const IntegerVector& alternative) : domain_{domain} {
    const auto& weights = domain.weights().integer;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      const auto n = robot[k] - alternative[k];
      if (n == 0) continue;
      const Surplus surplus{k, n > 0 ? n : -n, robot[k] != 0 && alternative[k] != 0};
      Difference& side = n > 0 ? taken_ : spared_;
      (weights[k] < 0 ? side.costs : side.gains).push_back(surplus);
      has_verbs_ = has_verbs_ && !domain.wording(k).do_one.empty();
    }
    is_tie_ = sign_of_dot(weights, robot - alternative) == 0;
  }

  [[nodiscard]] std::string sentence() const {
    if (taken_.gains.empty() && spared_.empty()) return for_nothing(taken_.costs);
    if (spared_.costs.empty() && taken_.empty()) return "it would do without " + nouns(spared_.gains) + " for nothing";
    if (is_tie_) return "it may as well " + infinitive(taken_) + " as " + infinitive(spared_);
    return has_verbs_ ? in_verbs() : in_nouns();
  }

 private:
  [[nodiscard]] std::string in_verbs() const {
    if (spared_.empty()) {
      return taken_.costs.empty() ? "it would rather " + verbs(taken_.gains) + " than not"
                                  : "it will " + verbs(taken_.costs) + " to " + verbs(taken_.gains);
    }
    if (taken_.empty() && spared_.gains.empty()) return "it would rather " + neither(spared_.costs);
    if (taken_.empty()) {
      return "it would rather do without " + nouns(spared_.gains) + " than " + verbs(spared_.costs);
    }
    if (taken_.costs.empty() && spared_.gains.empty()) {  // better in everything
      return "it would rather " + verbs(taken_.gains) + ", which also saves " + saved(spared_.costs);
    }
    if (!taken_.costs.empty() && !taken_.gains.empty() && spared_.costs.empty()) {
      return "it will " + verbs(taken_.costs) + " to " + verbs(taken_.gains) + " rather than " + verbs(spared_.gains);
    }
    return "it would rather " + joined_verbs(taken_, " and ") + " than " + joined_verbs(spared_, " to ");
  }

  [[nodiscard]] std::string in_nouns() const {
    if (spared_.empty()) {
      return taken_.costs.empty() ? "it chooses " + nouns(taken_.gains)
                                  : "it accepts " + nouns(taken_.costs) + " for " + nouns(taken_.gains);
    }
    if (taken_.empty() && spared_.gains.empty()) return "it avoids " + nouns(spared_.costs);
    if (taken_.costs.empty() && spared_.gains.empty()) {
      return "it chooses " + nouns(taken_.gains) + ", which also saves " + saved(spared_.costs);
    }
    if (taken_.empty()) return "it does without " + nouns(spared_.gains) + " to avoid " + nouns(spared_.costs);
    if (!taken_.costs.empty() && !taken_.gains.empty() && spared_.costs.empty()) {
      return "it accepts " + nouns(taken_.costs) + " for " + nouns(taken_.gains) + " rather than " +
             nouns(spared_.gains);
    }
    return "it prefers " + joined_nouns(taken_, " with ") + " to " + joined_nouns(spared_, " for ");
  }

  // What nobody does who gets nothing for it.
  [[nodiscard]] std::string for_nothing(const std::vector<Surplus>& costs) const {
    return "it would " + (has_verbs_ ? verbs(costs) : "accept " + nouns(costs)) + " for nothing";
  }

  // "not cross mud", "neither cross mud nor take 2 more steps": "not cross mud and take 2 more steps" could also mean
  // that it takes them.
  [[nodiscard]] std::string neither(const std::vector<Surplus>& all) const {
    if (all.size() == 1) return "not " + verbs(all);
    const std::vector<Surplus> first{all.begin(), all.end() - 1};
    std::string text = "neither";
    for (const auto& term : first) text += (text.size() > 7 ? ", " : " ") + verbs({term});
    return text + " nor " + verbs({all.back()});
  }
  // "2 steps" also where the other path has "2 more steps".
  [[nodiscard]] std::string saved(std::vector<Surplus> all) const {
    for (auto& one : all) one.more = false;
    return nouns(all);
  }

  // For either form, behind "may as well": "take 2 more steps", "do without eating a crumb", "accept 2 more steps".
  [[nodiscard]] std::string infinitive(const Difference& side) const {
    if (side.empty()) return "not";
    if (has_verbs_) return joined_verbs(side, " to ");
    return "accept " + joined_nouns(side, " for ");
  }

  [[nodiscard]] std::string joined_verbs(const Difference& side, const std::string& between) const {
    if (side.costs.empty() || side.gains.empty()) return verbs(side.costs.empty() ? side.gains : side.costs);
    return verbs(side.costs) + between + verbs(side.gains);
  }
  [[nodiscard]] std::string joined_nouns(const Difference& side, const std::string& between) const {
    if (side.costs.empty() || side.gains.empty()) return nouns(side.costs.empty() ? side.gains : side.costs);
    return nouns(side.costs) + between + nouns(side.gains);
  }
  [[nodiscard]] std::string verbs(const std::vector<Surplus>& all) const {
    std::vector<std::string> words;
    words.reserve(all.size());
    for (const auto& one : all) words.push_back(doing(domain_.wording(one.feature), one.n, one.more));
    return listed(words);
  }
  [[nodiscard]] std::string nouns(const std::vector<Surplus>& all) const {
    std::vector<std::string> words;
    for (const auto& one : all) {
      const auto& wording = domain_.wording(one.feature);
      words.push_back(one.more ? times_more(wording, one.n) : times(wording, one.n));
    }
    return listed(words);
  }

  const Domain& domain_;
  Difference taken_, spared_;
  bool has_verbs_ = true;
  bool is_tie_ = false;
};

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
  return Comparison{domain, robot, alternative}.sentence();
}

std::string prediction_in_words(const Domain& domain, const IntegerVector& predicted, const IntegerVector& robot) {
  check(domain, robot, predicted);
  return Comparison{domain, predicted, robot}.sentence();
}

HalfSpace constraint_of(const IntegerVector& robot, const IntegerVector& alternative) {
  return HalfSpace{robot - alternative};
}

std::string reason(const Domain& domain, const IntegerVector& robot, const IntegerVector& alternative) {
  check(domain, robot, alternative);
  return choice_in_words(domain, robot, alternative) + ": " + in_words(domain, constraint_of(robot, alternative));
}

}  // namespace kith
