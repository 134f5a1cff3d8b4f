#include "kith/teaching/exam_worth.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "kith/bec/near_miss.hpp"

namespace kith {
namespace {

constexpr std::size_t kWorthMdps = 8;
constexpr std::size_t kWorthStarts = 40;
constexpr std::size_t kWorthPeople = 128;

// Some candidates of some MDPs of the component, none of the exam's while there are others.
std::vector<StartIndex> starts_for_worth(const Atlas& atlas, const Exam& exam, const KnowledgeComponent& component) {
  std::vector<StartIndex> examined;
  for (const auto difficulty : {ExamDifficulty::kLow, ExamDifficulty::kMedium, ExamDifficulty::kHigh}) {
    const auto starts = exam.starts(difficulty);
    examined.insert(examined.end(), starts.begin(), starts.end());
  }
  const auto random = RandomStream{0}.split("worth");
  std::vector<std::pair<std::uint64_t, std::size_t>> mdps;
  for (std::size_t m = 0; m < component.uses_mdp.size(); ++m) {
    if (component.uses_mdp[m]) mdps.emplace_back(random.split("mdp").split(m).address(), m);
  }
  std::sort(mdps.begin(), mdps.end());
  if (mdps.size() > kWorthMdps) mdps.resize(kWorthMdps);
  struct Ranked {
    bool is_examined;
    std::uint64_t chance;
    StartIndex start;
  };
  std::vector<Ranked> ranked;
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start)) continue;
    const auto mdp = atlas.id(start).mdp.value();
    if (std::none_of(mdps.begin(), mdps.end(), [&](const auto& one) { return one.second == mdp; })) continue;
    ranked.push_back({std::find(examined.begin(), examined.end(), start) != examined.end(),
                      random.split("start").split(start.value()).address(), start});
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return std::pair{a.is_examined, a.chance} < std::pair{b.is_examined, b.chance};
  });
  if (ranked.size() > kWorthStarts) ranked.resize(kWorthStarts);
  std::vector<StartIndex> starts;
  for (const auto& one : ranked) starts.push_back(one.start);
  std::sort(starts.begin(), starts.end());
  return starts;
}

}  // namespace

ExamWorth::ExamWorth(Behaviours& behaviours, const Exam& exam, const PriorCover& cover, std::size_t component)
    : table_{exam.table()}, component_{component} {
  const auto& atlas = behaviours.atlas();
  if (table_ == nullptr) {
    for (const auto start : starts_for_worth(atlas, exam, atlas.knowledge_components()[component])) {
      paths_.push_back({start, {}, {}, grade_answer(atlas, start, std::nullopt), {}});
    }
    gather_paths(behaviours, cover);
  }
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const auto grade = of(behaviours, cover.point(i));
    before_.share_right += grade.share_right / static_cast<double>(cover.size());
    before_.regret += grade.regret / static_cast<double>(cover.size());
  }
}

void ExamWorth::gather_paths(Behaviours& behaviours, const PriorCover& cover) {
  const auto& atlas = behaviours.atlas();
  const auto& domain = atlas.domain();
  people_.push_back(domain.weights().unit);
  const auto n = std::min(kWorthPeople, cover.size());
  for (std::size_t i = 0; i < n; ++i) people_.push_back(cover.point((2 * i + 1) * cover.size() / (2 * n)));
  const auto& facets = atlas.knowledge_components()[component_].constraints;
  Cone region{domain.num_features()};
  if (region.clip(atlas.constraints().half_spaces(facets | atlas.prior()))) {
    for (const double miss : {0.5, 0.05}) {
      for (auto& person : near_misses(region, atlas.constraints().half_spaces(facets), miss)) people_.push_back(person);
    }
  }
  for (const auto& person : people_) {
    const auto cell = behaviours.locate(person);
    for (auto& paths : paths_) {
      const auto answer = behaviours.answer(paths.start, cell);
      paths.is_endless.push_back(!answer);
      if (!answer) continue;
      std::vector<double> counts;
      for (std::size_t k = 0; k < answer->size(); ++k) counts.push_back(static_cast<double>((*answer)[k]));
      bool is_known = false;
      for (std::size_t j = 0; j < paths.grades.size() && !is_known; ++j) {
        is_known = std::equal(counts.begin(), counts.end(),
                              paths.counts.begin() + static_cast<std::ptrdiff_t>(j * counts.size()));
      }
      if (is_known) continue;
      paths.counts.insert(paths.counts.end(), counts.begin(), counts.end());
      paths.grades.push_back(grade_answer(atlas, paths.start, answer));
    }
  }
}

std::size_t ExamWorth::nearest_person(const Direction& weights) const {
  std::size_t nearest = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const double product = people_[i].dot(weights);
    if (product > most) {
      most = product;
      nearest = i;
    }
  }
  return nearest;
}

std::vector<Grade> ExamWorth::of(Behaviours& behaviours, std::span<const std::vector<double>> axes) const {
  std::vector<Grade> grades;
  if (table_) {
    for (const auto cell : behaviours.atlas().tables().cells().locate(axes[0], axes[1], axes[2])) {
      grades.push_back(table_->component(PolicyCellIndex{cell}, component_));
    }
    return grades;
  }
  Direction weights(static_cast<Eigen::Index>(axes.size()));
  for (std::size_t i = 0; i < axes.front().size(); ++i) {
    for (std::size_t k = 0; k < axes.size(); ++k) weights[static_cast<Eigen::Index>(k)] = axes[k][i];
    grades.push_back(of(behaviours, weights));
  }
  return grades;
}

Grade ExamWorth::of(Behaviours& behaviours, const Direction& weights) const {
  if (table_) return table_->component(behaviours.locate(weights), component_);
  const auto d = static_cast<std::size_t>(weights.size());
  const auto nearest = nearest_person(weights);
  Grade grade;
  for (const auto& paths : paths_) {
    auto one = paths.endless;
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < paths.grades.size() && !paths.is_endless[nearest]; ++j) {
      double value = 0.0;
      for (std::size_t k = 0; k < d; ++k) value += weights[static_cast<Eigen::Index>(k)] * paths.counts[j * d + k];
      if (value > best) {
        best = value;
        one = paths.grades[j];
      }
    }
    grade.share_right += one.share_right / static_cast<double>(paths_.size());
    grade.regret += one.regret / static_cast<double>(paths_.size());
  }
  return grade;
}

}  // namespace kith
