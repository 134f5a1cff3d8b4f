#include <algorithm>
#include <cmath>
#include <functional>

#include "parameters.hpp"
#include "sections.hpp"

namespace kith::detail {
namespace {

// Two decimals; for masses.
std::string rounded(double value) {
  const auto hundredths = std::lround(value * 100.0);
  const auto digits = std::to_string(hundredths % 100);
  return std::to_string(hundredths / 100) + (digits.size() < 2 ? ".0" : ".") + digits;
}

std::string counted_periods(double periods) { return shortest(periods) + (periods == 1.0 ? " period" : " periods"); }

class Choice {
 public:
  Choice(const ReportDesign& design, const RunData& data) : design_{design}, data_{data} {
    for (std::size_t i = 0; i < data.teams.size(); ++i) {
      if (strategy_of(i) != kBaseline) candidates_.push_back(i);
    }
    together_ = !candidates_.empty();
    if (!together_) {
      for (std::size_t i = 0; i < data.teams.size(); ++i) candidates_.push_back(i);
    }
  }

  std::vector<TellingTeam> take() {
    add_extreme(known_,
                [&](std::size_t team) { return "the lowest " + name_of_known() + " (" + rounded(known_(team)) + ")"; });
    add_extreme([&](std::size_t team) { return -periods_of(team); },
                [&](std::size_t team) { return "the slowest (" + counted_periods(periods_of(team)) + ")"; });
    add_typical();
    std::reverse(chosen_.begin(), chosen_.end());
    return chosen_;
  }

 private:
  [[nodiscard]] const std::string& strategy_of(std::size_t team) const {
    return design_.series[design_.cells[design_.cell_of_team[team]].series].strategy;
  }

  [[nodiscard]] double periods_of(std::size_t team) const { return static_cast<double>(data_.teams[team].periods); }

  // The candidates of strategies without a chosen team; all others than those teams if there are none.
  [[nodiscard]] std::vector<std::size_t> others() const {
    std::vector<std::size_t> fresh, rest;
    for (const auto team : candidates_) {
      const auto same = [&](const auto& one) { return one.team == team; };
      const auto alike = [&](const auto& one) { return strategy_of(one.team) == strategy_of(team); };
      if (std::any_of(chosen_.begin(), chosen_.end(), same)) continue;
      rest.push_back(team);
      if (std::none_of(chosen_.begin(), chosen_.end(), alike)) fresh.push_back(team);
    }
    return fresh.empty() ? rest : fresh;
  }

  [[nodiscard]] std::string all_of_them(const std::vector<std::size_t>& among) const {
    if (among.size() == candidates_.size()) return together_ ? " of the teams taught together" : " of all teams";
    return " of the teams of other strategies";
  }

  void add_extreme(const std::function<double(std::size_t)>& size, const std::function<std::string(std::size_t)>& why) {
    const auto among = others();
    if (among.empty()) return;
    const auto least = [&](std::size_t a, std::size_t b) { return size(a) < size(b); };
    const auto overall = *std::min_element(candidates_.begin(), candidates_.end(), least);
    const auto best = *std::min_element(among.begin(), among.end(), least);
    chosen_.push_back({best, why(best) + all_of_them(size(best) <= size(overall) ? candidates_ : among)});
  }

  [[nodiscard]] std::string name_of_known() const {
    return data_.leads_with_exam ? "share right in the exam" : "final knowledge";
  }

  // Of the teams with the median number of periods the one whose knowledge is nearest to the median.
  void add_typical() {
    const auto among = others();
    if (among.empty()) return;
    const auto median = [&](const std::function<double(std::size_t)>& quantity) {
      std::vector<double> values;
      for (const auto team : candidates_) values.push_back(quantity(team));
      std::sort(values.begin(), values.end());
      return values[(values.size() - 1) / 2];
    };
    const double periods = median([&](std::size_t team) { return periods_of(team); });
    const double known = median(known_);
    const auto distance = [&](std::size_t team) {
      return std::pair{std::abs(periods_of(team) - periods), std::abs(known_(team) - known)};
    };
    const auto team = *std::min_element(among.begin(), among.end(),
                                        [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
    const std::string near = distance(team).first == 0.0 ? "" : "near ";
    chosen_.push_back({team, "typical: " + near + "the median of " + counted_periods(periods) + ", and " +
                                 (data_.leads_with_exam ? "share right" : "knowledge") + " (" + rounded(known_(team)) +
                                 ") near the median of " + rounded(known)});
  }

  const ReportDesign& design_;
  const RunData& data_;
  std::vector<std::size_t> candidates_;
  // What a team knows at the end: its share right where the exam leads.
  std::function<double(std::size_t)> known_ = [this](std::size_t team) {
    return data_.leads_with_exam ? data_.teams[team].exam->share_right : data_.teams[team].knowledge;
  };
  bool together_ = true;
  std::vector<TellingTeam> chosen_;
};

}  // namespace

std::vector<TellingTeam> telling_teams(const ReportDesign& design, const RunData& data) {
  return Choice{design, data}.take();
}

}  // namespace kith::detail
