#include "components.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace kith::detail {
namespace {

class Tarjan {
 public:
  explicit Tarjan(const Mdp& mdp) : mdp_{mdp}, number_(mdp.num_states(), 0), lowest_(mdp.num_states(), 0) {}

  Components run() && {
    found_.starts.push_back(0);
    for (std::size_t s = 0; s < number_.size(); ++s) {
      if (number_[s] == 0) explore(s);
    }
    return std::move(found_);
  }

 private:
  static constexpr std::uint32_t kDone = 0xFFFFFFFFu;  // as number: its component is known

  // A state whose transitions are being looked at.
  struct Visit {
    std::size_t state;
    std::size_t choice = 0;
    std::size_t outcome = 0;
  };

  void enter(std::size_t s) {
    number_[s] = lowest_[s] = ++last_number_;
    open_.push_back(s);
    visits_.push_back({s});
  }

  void explore(std::size_t root) {
    enter(root);
    while (!visits_.empty()) {
      if (const auto next = next_transition(visits_.back())) {
        if (number_[*next] == 0) {
          enter(*next);
        } else if (number_[*next] != kDone) {
          std::uint32_t& lowest = lowest_[visits_.back().state];
          lowest = std::min(lowest, number_[*next]);
        }
        continue;
      }
      const std::size_t s = visits_.back().state;
      visits_.pop_back();
      if (!visits_.empty()) {
        std::uint32_t& lowest = lowest_[visits_.back().state];
        lowest = std::min(lowest, lowest_[s]);
      }
      if (lowest_[s] == number_[s]) close(s);
    }
  }

  // The next non-terminal state that the visited one leads to.
  std::optional<std::size_t> next_transition(Visit& visit) const {
    const auto choices = mdp_.choices(StateIndex{visit.state});
    for (; visit.choice < choices.size(); ++visit.choice, visit.outcome = 0) {
      const auto outcomes = mdp_.outcomes(choices[visit.choice]);
      while (visit.outcome < outcomes.size()) {
        const StateIndex next = outcomes[visit.outcome++].next;
        if (!mdp_.is_terminal(next)) return next.value();
      }
    }
    return std::nullopt;
  }

  // The open states down to s are one component.
  void close(std::size_t s) {
    std::size_t member = 0;
    do {
      member = open_.back();
      open_.pop_back();
      number_[member] = kDone;
      found_.states.push_back(StateIndex{member});
    } while (member != s);
    std::sort(found_.states.begin() + found_.starts.back(), found_.states.end());
    found_.starts.push_back(static_cast<std::uint32_t>(found_.states.size()));
  }

  const Mdp& mdp_;
  std::vector<std::uint32_t> number_;  // in order of discovery from 1; 0: not yet seen
  std::vector<std::uint32_t> lowest_;  // the earliest open state that is reached
  std::vector<std::size_t> open_;
  std::vector<Visit> visits_;
  std::uint32_t last_number_ = 0;
  Components found_;
};

}  // namespace

Components strong_components(const Mdp& mdp) { return Tarjan{mdp}.run(); }

}  // namespace kith::detail
