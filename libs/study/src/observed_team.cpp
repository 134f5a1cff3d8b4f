#include "kith/study/observed_team.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace kith {
namespace {

StartIndex start_of(const Atlas& atlas, std::size_t mdp, std::size_t start) {
  const auto& domain = atlas.domain();
  if (mdp >= domain.num_mdps() || start >= domain.mdp(MdpIndex{mdp}).num_states()) {
    throw std::invalid_argument{"observed_people: the domain has no such start"};
  }
  return atlas.index({MdpIndex{mdp}, StateIndex{start}});
}

class Observations {
 public:
  Observations(const Atlas& atlas, const TeamRecord& record)
      : atlas_{atlas}, people_(record.address.composition.size()) {
    for (const auto& shown : record.demonstration_records) add(shown);
    for (const auto& response : record.responses) add(response);
    for (auto& periods : people_) {
      for (auto& [number, period] : periods) {
        period.all_correct = std::all_of(period.verdicts.begin(), period.verdicts.end(),
                                         [](const Verdict& verdict) { return verdict.correct; });
      }
    }
    for (const auto& discussed : record.discussions) add(discussed);
  }

  [[nodiscard]] std::vector<std::vector<ObservedPeriod>> people() const {
    std::vector<std::vector<ObservedPeriod>> result;
    for (const auto& periods : people_) {
      auto& person = result.emplace_back();
      for (const auto& [number, period] : periods) person.push_back(period);
    }
    return result;
  }

 private:
  ObservedPeriod& at(std::size_t member, std::size_t period, std::size_t component) {
    if (component < 1 || component > atlas_.knowledge_components().size()) {
      throw std::invalid_argument{"observed_people: the domain has no such component"};
    }
    auto& result = people_.at(member - 1)[period];
    result.period = period;
    result.component = component - 1;
    return result;
  }

  void add(const DemonstrationRecord& shown) {
    const bool everybody = shown.member == 0;
    const auto first = everybody ? 1 : shown.member;
    const auto last = everybody ? people_.size() : shown.member;
    for (auto member = first; member <= last; ++member) {
      at(member, shown.period, shown.component)
          .demonstrations.push_back({.start = start_of(atlas_, shown.mdp, shown.start),
                                     .half_spaces = shown.constraints,
                                     .counterfactuals = {}});
    }
  }

  void add(const ResponseRecord& response) {
    auto& period = at(response.member, response.period, response.component);
    period.tests.push_back({.start = start_of(atlas_, response.mdp, response.start), .covered = response.covered});
    period.answers.push_back(response.answer);
    period.verdicts.push_back({.correct = response.correct,
                               .regret = response.regret.value_or(0.0),
                               .answered = response.answer.has_value(),
                               .half_spaces = response.constraints});
    for (const auto& half_space : response.covered) {  // once, however many tests examine it, as a Session does
      const bool is_new =
          std::find(period.feedback.begin(), period.feedback.end(), half_space) == period.feedback.end();
      if (is_new) period.feedback.push_back(half_space);
    }
  }

  // What was answered in the end is what was right or wrong.
  void add(const DiscussionRecord& answer) {
    auto& period = at(answer.member, answer.period, answer.component);
    period.all_correct = answer.revised_correct && (period.all_correct || !period.discussed);
    period.discussed = true;
  }

  const Atlas& atlas_;
  std::vector<std::map<std::size_t, ObservedPeriod>> people_;  // by period
};

}  // namespace

std::vector<std::vector<ObservedPeriod>> observed_people(const Atlas& atlas, const TeamRecord& record) {
  return Observations{atlas, record}.people();
}

}  // namespace kith
