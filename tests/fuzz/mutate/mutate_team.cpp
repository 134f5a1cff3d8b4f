#include "mutate_team.hpp"

#include <array>
#include <limits>

namespace kith::fuzzing {
namespace {

constexpr std::array<double, 12> kReals{0.0,
                                        -0.0,
                                        0.5,
                                        1.0,
                                        -1.0,
                                        1e-320,
                                        1e308,
                                        std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity(),
                                        std::numeric_limits<double>::quiet_NaN(),
                                        0.1,
                                        2.0 / 3.0};
constexpr std::array<std::size_t, 9> kCounts{0, 1, 2, 127, 128, 255, 16384, std::size_t{1} << 32, ~std::size_t{0}};
const std::array<std::string, 7>& texts() {
  static const std::array<std::string, 7> kTexts{
      "", "common", "joint", "own 1", "member 2", std::string(1, '\0'), std::string(200, 'a')};
  return kTexts;
}

template <typename Part>
void change(std::vector<Part>& list, Dice& dice) {
  const auto i = list.empty() ? 0 : dice.below(list.size());
  const auto at = list.begin() + static_cast<std::ptrdiff_t>(i);
  if (list.empty() || dice.one_in(4)) {
    list.emplace_back();
  } else if (dice.one_in(3)) {
    list.erase(at);
  } else if (dice.one_in(2)) {
    const auto copy = list[i];
    list.insert(at, copy);
  } else {
    std::swap(list[i], list[dice.below(list.size())]);
  }
}

void change(std::vector<HalfSpace>& list, Dice& dice) {
  IntegerVector normal(2 + dice.below(4));
  for (std::size_t k = 0; k < normal.size(); ++k) normal[k] = static_cast<std::int64_t>(dice.below(9)) - 4;
  if (normal.is_zero() || dice.one_in(8)) {
    list.clear();
  } else {
    list.emplace_back(normal);
  }
}

void change(ResponseRecord& x, Dice& dice) {
  const auto what = dice.below(5);
  if (what == 0) x.regret = dice.one_in(3) ? std::nullopt : std::optional{dice.pick(kReals)};
  if (what == 1) x.answer = dice.one_in(3) ? std::nullopt : std::optional{IntegerVector(dice.below(9))};
  if (what == 2) change(x.constraints, dice);
  if (what == 3) change(x.covered, dice);
  if (what == 4) x.correct = !x.correct;
}

// All numbers and texts of a record, to choose from.
struct Places {
  std::vector<double*> reals;
  std::vector<std::size_t*> counts;
  std::vector<std::string*> texts;
  std::vector<char*> letters;
};

Places places_of(TeamRecord& r) {
  Places p;
  p.reals = {&r.knowledge, &r.knowledge_min, &r.area_sr};
  p.counts = {&r.periods, &r.demonstrations, &r.tests, &r.components_learned, &r.components_skipped};
  p.texts = {&r.seed_address};
  for (auto& x : r.learners) {
    for (auto& trait : x.traits) p.reals.push_back(&trait);
    p.reals.push_back(&x.p_bec);
    p.counts.insert(p.counts.end(), {&x.member, &x.periods, &x.tests, &x.correct});
    p.letters.push_back(&x.type);
  }
  for (auto& x : r.period_records) {
    p.reals.insert(p.reals.end(), {&x.area_sr, &x.running_area_sr, &x.gain});
    for (auto& number : x.p_bec) p.reals.push_back(&number);
    p.counts.insert(p.counts.end(), {&x.period, &x.member, &x.component, &x.tests, &x.excluded, &x.untested});
    p.texts.push_back(&x.source);
  }
  for (auto& x : r.beliefs) {
    for (auto& number : x.points) p.reals.push_back(&number);
    for (auto& number : x.weights) p.reals.push_back(&number);
    p.texts.push_back(&x.belief);
  }
  for (auto& x : r.demonstration_records) p.counts.insert(p.counts.end(), {&x.period, &x.mdp, &x.start});
  for (auto& x : r.responses) p.counts.insert(p.counts.end(), {&x.period, &x.test, &x.mdp, &x.start});
  for (auto& x : r.progress) {
    if (x.ability) p.reals.push_back(&*x.ability);
    p.reals.push_back(&x.p_bec);
    p.letters.push_back(&x.type);
  }
  return p;
}

void change_list(TeamRecord& r, Dice& dice) {
  switch (dice.below(8)) {
    case 0:
      return change(r.learners, dice);
    case 1:
      return change(r.period_records, dice);
    case 2:
      return change(r.beliefs, dice);
    case 3:
      return change(r.demonstration_records, dice);
    case 4:
      return change(r.responses, dice);
    case 5:
      return change(r.progress, dice);
    case 6:
      if (!r.beliefs.empty()) change(dice.one_in(2) ? r.beliefs[0].points : r.beliefs[0].weights, dice);
      return;
    default:
      if (!r.demonstration_records.empty()) change(r.demonstration_records[0].constraints, dice);
  }
}

}  // namespace

void mutate_team(TeamRecord& record, Dice& dice) {
  const auto places = places_of(record);
  switch (dice.below(6)) {
    case 0:
      *dice.pick(places.reals) = dice.pick(kReals);
      return;
    case 1:
      *dice.pick(places.counts) = dice.pick(kCounts);
      return;
    case 2:
      *dice.pick(places.texts) = dice.pick(texts());
      return;
    case 3:
      if (!record.responses.empty()) return change(record.responses[dice.below(record.responses.size())], dice);
      [[fallthrough]];
    case 4:
      if (!places.letters.empty() && dice.one_in(3)) *dice.pick(places.letters) = static_cast<char>(dice.below(256));
      record.status = static_cast<SessionStatus>(dice.below(4));
      return;
    default:
      return change_list(record, dice);
  }
}

void cross_teams(TeamRecord& record, const TeamRecord& other, Dice& dice) {
  if (dice.one_in(2)) record.learners = other.learners;
  if (dice.one_in(2)) record.period_records = other.period_records;
  if (dice.one_in(2)) record.beliefs = other.beliefs;
  if (dice.one_in(2)) record.demonstration_records = other.demonstration_records;
  if (dice.one_in(2)) record.responses = other.responses;
  if (dice.one_in(2)) record.progress = other.progress;
}

}  // namespace kith::fuzzing
