#include "kith/teaching/answer_fit.hpp"

#include <algorithm>
#include <optional>

#include "count_distribution.hpp"

namespace kith {
namespace {

constexpr double kAgainstBelief = 0.1;  // for a path that is best for nobody, if it contradicts what one believes

// Whether nobody who knows the prior satisfies one of them.
bool is_beyond_prior(const Atlas& atlas, std::span<const HalfSpace> half_spaces) {
  return std::any_of(half_spaces.begin(), half_spaces.end(),
                     [&](const HalfSpace& h) { return !atlas.prior_cone().clipped(h); });
}

}  // namespace

std::span<const std::uint32_t> PointCells::of(const Atlas& atlas, const ParticleBelief& belief) {
  if (cells_.empty() || num_resamplings_ != belief.num_resamplings()) {
    num_resamplings_ = belief.num_resamplings();
    cells_ = atlas.tables().cells().locate(belief.x(), belief.y(), belief.z());
  }
  return cells_;
}

AnswerFit::AnswerFit(const Atlas& atlas, std::span<const Test> tests, std::span<const Answer> answers,
                     std::span<const Verdict> verdicts, Missing missing)
    : atlas_{&atlas}, tables_{atlas.find_tables()} {
  if (tables_) {
    factor_of_cell_.assign(tables_->cells().size(), 1.0);
    num_right_of_cell_.assign(tables_->cells().size(), 0);
  }
  for (auto& guess : guesses_) guess.right = {1.0};
  for (std::size_t t = 0; t < tests.size() && t < verdicts.size(); ++t) {
    const auto answer = t < answers.size() ? answers[t] : std::nullopt;
    if (!answer && missing == Missing::kSaysNothing) continue;
    OneTest test{.chance = chance(), .right_by_chance = chance()};
    auto answered_by = verdicts[t].half_spaces;
    const bool is_impossible = !answer || is_beyond_prior(atlas, answered_by);
    if (tables_) {
      read_cells(tests[t], answer, test);
    } else {
      const auto examined =
          atlas.constraints().half_spaces(atlas.tested_constraints(tests[t].start).without(atlas.prior()));
      test.examined = numbers_of(examined);
      if (verdicts[t].correct) answered_by = examined;
      test.by_nobody = is_impossible;
    }
    if (!test.by_cell && !is_impossible) test.answered_by = numbers_of(answered_by);
    num_right_ += verdicts[t].correct ? 1u : 0u;
    for (std::size_t g = 0; g < guesses_.size(); ++g) {
      double probability = chance(), right = chance();
      if (test.num_paths > 0.0) {
        const double nobodys = best_for_nobody(g == 0 ? Guess::kSensible : Guess::kAny);
        probability = test.by_nobody ? nobodys : (1.0 - nobodys) / test.num_paths;
        right = test.right_by_chance * (1.0 - nobodys) * (test.num_paths + 1.0) / test.num_paths;
      }
      guesses_[g].likelihood *= probability;
      guesses_[g].right = convolved(guesses_[g].right, std::vector{1.0 - right, right});
    }
    tests_.push_back(std::move(test));
    if (answer) given_.push_back({tests[t].start, *answer});
  }
}

// What people of each policy cell answer to a test.
void AnswerFit::read_cells(const Test& asked, const Answer& answer, OneTest& test) {
  const auto& domain = atlas_->domain();
  const auto hull = tables_->hull(asked.start);
  const auto& losses = tables_->hull(hull).losses;
  const auto given =
      answer ? std::find(losses.begin(), losses.end(), atlas_->feature_counts(asked.start) - *answer) : losses.end();
  test.by_cell = given != losses.end();
  test.by_nobody = !test.by_cell;
  std::vector<bool> is_right;
  for (const auto& loss : losses) is_right.push_back(sign_of_dot(domain.weights().integer, loss) == 0);
  test.num_paths = static_cast<double>(losses.size());
  test.chance = 1.0 / (test.num_paths + 1.0);
  test.right_by_chance = static_cast<double>(std::count(is_right.begin(), is_right.end(), true)) * test.chance;
  const auto number = static_cast<std::size_t>(given - losses.begin());
  for (std::size_t c = 0; c < factor_of_cell_.size(); ++c) {
    const auto choice = tables_->cells().choice(PolicyCellIndex{c}, hull);
    if (choice == PolicyCells::kNone) {
      factor_of_cell_[c] = -1.0;
      continue;
    }
    num_right_of_cell_[c] += is_right[choice] ? 1u : 0u;
    if (test.by_cell) factor_of_cell_[c] *= slip() * test.chance + (choice == number ? 1.0 - slip() : 0.0);
  }
}

std::vector<std::size_t> AnswerFit::numbers_of(std::span<const HalfSpace> half_spaces) {
  std::vector<std::size_t> numbers;
  for (const auto& half_space : half_spaces) {
    const auto known = std::find(half_spaces_.begin(), half_spaces_.end(), half_space);
    numbers.push_back(static_cast<std::size_t>(known - half_spaces_.begin()));
    if (known == half_spaces_.end()) half_spaces_.push_back(half_space);
  }
  return numbers;
}

// Which points lie in each of half_spaces_.
AnswerFit::Inside AnswerFit::locate(const ParticleBelief& belief) const {
  Inside inside;
  std::vector<double> margins(belief.size());
  for (const auto& half_space : half_spaces_) {
    std::fill(margins.begin(), margins.end(), 0.0);
    for (std::size_t k = 0; k < belief.dimension(); ++k) {
      const auto axis = belief.axis(k);
      const auto entry = static_cast<double>(half_space.normal()[k]);
      for (std::size_t i = 0; i < margins.size(); ++i) margins[i] += entry * axis[i];
    }
    auto& signs = inside.emplace_back(margins.size());
    for (std::size_t i = 0; i < margins.size(); ++i) signs[i] = margins[i] >= 0.0 ? 1 : 0;
  }
  return inside;
}

// What the points of a belief say of the tests that are not told by policy cells.
std::vector<AnswerFit::PointFit> AnswerFit::rate(const ParticleBelief& belief) const {
  const auto inside = locate(belief);
  const auto within_all = [&](const std::vector<std::size_t>& half_spaces) {
    std::vector<char> all(belief.size(), 1);
    for (const auto h : half_spaces) {
      for (std::size_t i = 0; i < all.size(); ++i) all[i] &= inside[h][i];
    }
    return all;
  };
  std::vector<PointFit> fits;
  for (const auto& test : tests_) {
    if (test.by_cell) continue;
    const double by_slip = slip() * test.chance;
    fits.push_back({.fits = within_all(test.answered_by),
                    .if_fits = by_slip + (test.by_nobody ? 0.0 : 1.0 - slip()),
                    .else_factor = test.by_nobody ? by_slip * kAgainstBelief : by_slip});
    if (tables_ == nullptr) fits.back().is_right = within_all(test.examined);
  }
  return fits;
}

// What becomes of the number of right answers by slips, taking the tests for equally easy to guess.
std::vector<double> AnswerFit::with_slips(const std::vector<double>& right) const {
  double by_chance = 0.0;
  for (const auto& test : tests_) by_chance += test.right_by_chance / static_cast<double>(tests_.size());
  const double stays = 1.0 - slip() * (1.0 - by_chance), turns = slip() * by_chance;
  std::vector<double> result(right.size(), 0.0);
  for (std::size_t k = 0; k < right.size(); ++k) {
    if (right[k] == 0.0) continue;
    std::vector<double> spread{1.0};
    for (std::size_t t = 0; t < tests_.size(); ++t) {
      const double p = t < k ? stays : turns;
      spread = convolved(spread, std::vector{1.0 - p, p});
    }
    for (std::size_t n = 0; n < spread.size(); ++n) result[n] += right[k] * spread[n];
  }
  return result;
}

bool AnswerFit::is_by_cells() const noexcept {
  return tables_ != nullptr && std::all_of(tests_.begin(), tests_.end(), [](const auto& test) { return test.by_cell; });
}

AnswerFit::Rating AnswerFit::of(std::span<const double> cell_masses) const {
  std::vector<double> right(tests_.size() + 1, 0.0);
  double likelihood = 0.0, any = 0.0;
  for (std::size_t c = 0; c < cell_masses.size(); ++c) {
    if (factor_of_cell_[c] < 0.0 || cell_masses[c] == 0.0) continue;
    any += cell_masses[c];
    likelihood += cell_masses[c] * factor_of_cell_[c];
    right[num_right_of_cell_[c]] += cell_masses[c];
  }
  if (!(any > 0.0)) return of(Guess::kAny);  // who has no answer can only have guessed
  for (double& mass : right) mass /= any;
  return {likelihood / any, with_slips(right)};
}

AnswerFit::Rating AnswerFit::of(const ParticleBelief& belief, PointCells& cells) const {
  const auto masses = belief.weights();
  const bool tabulated = tables_ != nullptr;
  const auto fits = rate(belief);
  const auto cell_of = tabulated ? cells.of(*atlas_, belief) : std::span<const std::uint32_t>{};
  std::vector<double> right(tests_.size() + 1, 0.0);
  double likelihood = 0.0, any = 0.0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    if (masses[i] == 0.0) continue;
    double fit = tabulated ? factor_of_cell_[cell_of[i]] : 1.0;
    if (fit < 0.0) continue;
    std::size_t num_right = tabulated ? num_right_of_cell_[cell_of[i]] : 0;
    for (const auto& one : fits) {
      fit *= one.fits[i] != 0 ? one.if_fits : one.else_factor;
      if (!tabulated) num_right += one.is_right[i] != 0 ? 1u : 0u;
    }
    any += masses[i];
    likelihood += masses[i] * fit;
    right[num_right] += masses[i];
  }

  if (!(any > 0.0)) return of(Guess::kAny);  // who has no answer can only have guessed
  for (double& mass : right) mass /= any;
  return {likelihood / any, with_slips(right)};
}

}  // namespace kith
