#include "sections.hpp"

#include "kith/analysis/effect_size.hpp"
#include "team_tables.hpp"

namespace kith::detail {
namespace {

std::size_t people_of(const RunFiles& run, const ReportDesign& design, std::size_t series, std::size_t type) {
  const auto& people = design.series[series].people;
  const auto found = people.find(run.types()[type].letter);
  return found == people.end() ? 0 : found->second;
}

bool enough(std::size_t reached, std::size_t people) {
  constexpr std::size_t kFew = 10;
  return reached >= kFew || 5 * reached >= people;
}

Json person_keys(const RunFiles& run, const ReportDesign& design, const PeopleKey& key) {
  return Json::array({design.series[key[0]].code, std::string{run.types()[key[1]].letter}});
}

}  // namespace

Json knowledge_by_period_table(const RunFiles& run, const ReportDesign& design, const RunData& data,
                               const std::vector<double>& before) {
  JsonTable table{{"strategy", "type", "period", "mean", "low", "high", "people"}};
  std::size_t series = design.series.size(), type = 0;
  for (const auto& [key, values] : data.knowledge) {
    const auto people = people_of(run, design, key[0], key[1]);
    if (key[0] != series || key[1] != type) {
      series = key[0];
      type = key[1];
      auto row = person_keys(run, design, key);
      row.push_back(0);
      for (int i = 0; i < 3; ++i) row.push_back(number(before[type]));
      row.push_back(people);
      table.add(std::move(row));
    }
    if (!enough(values.size(), people)) continue;
    auto row = person_keys(run, design, key);
    row.push_back(key[3]);
    auto all = values;  // and of those who are no longer taught, what they knew last
    for (const auto& [end, known] : data.knowledge_at_end) {
      if (end[0] == key[0] && end[1] == key[1] && end[3] < key[3]) all.insert(all.end(), known.begin(), known.end());
    }
    add_interval(row, all);
    row.push_back(all.size());
    table.add(std::move(row));
  }
  return std::move(table).take();
}

Json correct_by_period_table(const RunFiles& run, const ReportDesign& design, const RunData& data) {
  JsonTable table{{"strategy", "type", "period", "share", "low", "high", "answers"}};
  for (const auto& [key, values] : data.answers) {
    if (!enough(values.people, people_of(run, design, key[0], key[1]))) continue;
    const auto share = wilson_interval(values.correct, values.answers);
    auto row = person_keys(run, design, key);
    row.push_back(key[3]);
    for (const double value : {share.estimate, share.low, share.high}) row.push_back(number(value));
    row.push_back(values.answers);
    table.add(std::move(row));
  }
  return std::move(table).take();
}

}  // namespace kith::detail
