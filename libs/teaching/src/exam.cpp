#include "kith/teaching/exam.hpp"

#include <algorithm>
#include <numeric>

#include "kith/core/distributions.hpp"
#include "kith/domains/judgement.hpp"

namespace kith {
namespace {

constexpr std::size_t kSampledMdps = 6;
constexpr std::size_t kSampledPerMdp = 15;
constexpr std::size_t kSampledPerThird = 10;
constexpr std::size_t kDraws = 16;

RandomStream exam_stream() { return RandomStream{0}.split("exam"); }

double worst_deviation(const Atlas& atlas, StartIndex start) {
  const auto id = atlas.id(start);
  const auto& mdp = atlas.domain().mdp(id.mdp);
  double worst = 0.0;
  for (std::size_t choice = 0; choice < mdp.choices(id.start).size(); ++choice) {
    const auto counts = atlas.deviation_counts(start, choice);
    worst = std::max(worst, judge_path(atlas.domain(), atlas.feature_counts(start), counts).raw_regret);
  }
  return worst;
}

}  // namespace

Grade grade_answer(const Atlas& atlas, StartIndex start, const std::optional<IntegerVector>& answer) {
  if (!answer) return {0.0, worst_deviation(atlas, start)};
  const auto judged = judge_path(atlas.domain(), atlas.feature_counts(start), *answer);
  return judged.is_right ? Grade{1.0, 0.0} : Grade{0.0, judged.raw_regret};
}

Exam::Exam(Behaviours& behaviours, const PriorCover& cover) {
  const auto& atlas = behaviours.atlas();
  std::vector<StartIndex> starts;
  std::vector<double> share_right;
  if (const auto* tables = atlas.find_tables()) {
    table_.emplace(atlas);
    std::vector<double> mass(tables->cells().size(), 0.0);
    for (std::size_t i = 0; i < cover.size(); ++i) mass[behaviours.locate(cover.point(i)).value()] += 1.0;
    std::vector<double> of_hull(tables->num_hulls(), 0.0);
    for (std::size_t h = 0; h < of_hull.size(); ++h) {
      for (std::size_t c = 0; c < mass.size(); ++c) {
        if (table_->is_right(PolicyCellIndex{c}, HullIndex{h})) of_hull[h] += mass[c];
      }
    }
    for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
      if (!atlas.is_candidate(start)) continue;
      starts.push_back(start);
      share_right.push_back(of_hull[tables->hull(start).value()]);
    }
  } else {
    starts = sampled_starts(atlas);
    share_right.assign(starts.size(), 0.0);
    for (std::size_t draw = 0; draw < kDraws; ++draw) {
      const auto cell = behaviours.locate(cover.point((2 * draw + 1) * cover.size() / (2 * kDraws)));
      for (std::size_t i = 0; i < starts.size(); ++i) {
        share_right[i] += grade_answer(atlas, starts[i], behaviours.answer(starts[i], cell)).share_right;
      }
    }
  }
  sort_by_difficulty(std::move(starts), share_right);
}

// Candidates of a few MDPs, every one as likely as any other of its MDP.
std::vector<StartIndex> Exam::sampled_starts(const Atlas& atlas) const {
  std::vector<std::vector<StartIndex>> by_mdp;
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    const auto mdp = atlas.id(start).mdp.value();
    if (by_mdp.size() <= mdp) by_mdp.resize(mdp + 1);
    if (atlas.is_candidate(start)) by_mdp[mdp].push_back(start);
  }
  std::erase_if(by_mdp, [](const auto& demos) { return demos.empty(); });
  const auto chance = [](const RandomStream& random, std::size_t i) { return random.split(i).address(); };
  const auto root = exam_stream();
  std::vector<std::size_t> mdps(by_mdp.size());
  std::iota(mdps.begin(), mdps.end(), std::size_t{0});
  std::sort(mdps.begin(), mdps.end(),
            [&](auto a, auto b) { return chance(root.split("mdps"), a) < chance(root.split("mdps"), b); });
  if (mdps.size() > kSampledMdps) mdps.resize(kSampledMdps);
  std::vector<StartIndex> starts;
  for (const auto m : mdps) {
    auto& demos = by_mdp[m];
    std::sort(demos.begin(), demos.end(), [&](StartIndex a, StartIndex b) {
      return chance(root.split("starts"), a.value()) < chance(root.split("starts"), b.value());
    });
    if (demos.size() > kSampledPerMdp) demos.resize(kSampledPerMdp);
    starts.insert(starts.end(), demos.begin(), demos.end());
  }
  return starts;
}

// The thirds, easiest first; where there are no tables, a sample of each.
void Exam::sort_by_difficulty(std::vector<StartIndex> starts, const std::vector<double>& share_right) {
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return share_right[a] > share_right[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    by_difficulty_[3 * i / order.size()].push_back(starts[order[i]]);
  }
  for (auto& third : by_difficulty_) {
    if (!table_ && third.size() > kSampledPerThird) {
      std::vector<StartIndex> some;
      for (std::size_t i = 0; i < kSampledPerThird; ++i) some.push_back(third[i * third.size() / kSampledPerThird]);
      third = std::move(some);
    }
    std::sort(third.begin(), third.end());
  }
}

ExamGrades Exam::grade(const ParticleBelief& belief, Behaviours& behaviours) const {
  if (!table_) return grade_sample(belief, behaviours);
  const auto& cells = behaviours.atlas().tables().cells();
  std::vector<double> mass(cells.size(), 0.0);
  const auto weights = belief.weights();
  const auto numbers = cells.locate(belief.x(), belief.y(), belief.z());
  for (std::size_t i = 0; i < weights.size(); ++i) mass[numbers[i]] += weights[i];
  ExamGrades grades;
  grades.components.resize(table_->num_components());
  const auto add = [](Grade& sum, const Grade& grade, double weight) {
    sum.share_right += weight * grade.share_right;
    sum.regret += weight * grade.regret;
  };
  for (std::size_t c = 0; c < mass.size(); ++c) {
    if (mass[c] == 0.0) continue;
    add(grades.all, table_->all(PolicyCellIndex{c}), mass[c]);
    for (std::size_t k = 0; k < grades.components.size(); ++k) {
      add(grades.components[k], table_->component(PolicyCellIndex{c}, k), mass[c]);
    }
  }
  return grades;
}

ExamGrades Exam::grade_sample(const ParticleBelief& belief, Behaviours& behaviours) const {
  const auto& atlas = behaviours.atlas();
  const auto& components = atlas.knowledge_components();
  ExamGrades grades;
  grades.components.resize(components.size());
  std::vector<double> totals(components.size(), 0.0);
  double total = 0.0;
  const auto add = [](Grade& sum, const Grade& grade, double weight) {
    sum.share_right += weight * grade.share_right;
    sum.regret += weight * grade.regret;
  };
  for (const auto& draw : belief.systematic_draws(kDraws, exam_stream().split("draws"))) {
    const auto cell = behaviours.locate(belief.point(draw.index));
    const auto weight = static_cast<double>(draw.count);
    for (const auto& third : by_difficulty_) {
      for (const auto start : third) {
        const auto grade = grade_answer(atlas, start, behaviours.answer(start, cell));
        add(grades.all, grade, weight);
        total += weight;
        for (std::size_t k = 0; k < components.size(); ++k) {
          if (!components[k].uses_mdp[atlas.id(start).mdp.value()]) continue;
          add(grades.components[k], grade, weight);
          totals[k] += weight;
        }
      }
    }
  }

  const auto divide = [](Grade& sum, double by) {
    sum.share_right /= std::max(by, 1.0);
    sum.regret /= std::max(by, 1.0);
  };
  divide(grades.all, total);
  for (std::size_t k = 0; k < components.size(); ++k) divide(grades.components[k], totals[k]);
  return grades;
}

std::vector<StartIndex> Exam::questions(std::size_t n, std::span<const StartIndex> seen, RandomStream random) const {
  constexpr int kTries = 200;
  std::vector<StartIndex> chosen;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& starts = by_difficulty_[i % by_difficulty_.size()];
    if (starts.empty()) continue;
    auto start = starts.front();
    for (int attempt = 0; attempt < kTries; ++attempt) {
      start = starts[uniform_index(starts.size(), random)];
      const bool is_old = std::find(seen.begin(), seen.end(), start) != seen.end() ||
                          std::find(chosen.begin(), chosen.end(), start) != chosen.end();
      if (!is_old) break;
    }
    if (std::find(chosen.begin(), chosen.end(), start) == chosen.end()) chosen.push_back(start);
  }
  return chosen;
}

}  // namespace kith
