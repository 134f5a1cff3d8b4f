#include "kith/teaching/lesson_beliefs.hpp"

#include <algorithm>
#include <stdexcept>

#include "ability_limits.hpp"

namespace kith {

double KnownBelief::mass_in(std::span<const HalfSpace> half_spaces) {
  for (const auto& [asked, mass] : masses_) {
    if (std::equal(asked.begin(), asked.end(), half_spaces.begin(), half_spaces.end())) return mass;
  }
  masses_.emplace_back(std::vector<HalfSpace>(half_spaces.begin(), half_spaces.end()), belief_.mass_in(half_spaces));
  return masses_.back().second;
}

std::span<const double> KnownBelief::cell_masses(const Atlas& atlas) {
  if (cell_masses_.empty()) {
    cell_masses_.assign(atlas.tables().cells().size(), 0.0);
    const auto cells = cells_->of(atlas, belief_);
    for (std::size_t i = 0; i < cells.size(); ++i) cell_masses_[cells[i]] += belief_.weights()[i];
  }
  return cell_masses_;
}

AnswerFit::Rating KnownBelief::rating(const Atlas& atlas, const AnswerFit& fit) {
  return fit.is_by_cells() ? fit.of(cell_masses(atlas)) : fit.of(belief_, *cells_);
}

LessonBeliefs::LessonBeliefs(TeachingCache& cache, Options options, std::span<const Cone> priors,
                             const RandomStream& random)
    : options_{std::move(options)}, random_{random} {
  require_hypotheses(options_.hypotheses);
  for (const auto& prior : priors) {
    const auto known = starts_.empty() ? options_.known : std::nullopt;  // misconceptions are about the robot as it is
    starts_.emplace_back(ParticleBelief{cache.cover(prior, options_.filter.particles, known), options_.filter});
  }
  chains_.assign(starts_.size(), std::vector<Chain>(options_.hypotheses.size()));
}

bool LessonBeliefs::are_same(const ObservedPeriod& a, const ObservedPeriod& b) {
  const auto shows_the_same = [](const Demonstration& one, const Demonstration& other) {
    return one.half_spaces == other.half_spaces;
  };
  return a.period == b.period && a.component == b.component && a.feedback == b.feedback &&
         std::equal(a.demonstrations.begin(), a.demonstrations.end(), b.demonstrations.begin(), b.demonstrations.end(),
                    shows_the_same);
}

void LessonBeliefs::take(std::size_t t, const ObservedPeriod& period) {
  if (t > lessons_.size() || (t < lessons_.size() && !are_same(lessons_[t].period, period))) {
    throw std::invalid_argument{"LessonBeliefs: these are other lessons"};
  }
  if (t < lessons_.size()) return;
  auto& lesson = lessons_.emplace_back();
  lesson.period.period = period.period;
  lesson.period.component = period.component;
  lesson.period.demonstrations = period.demonstrations;
  lesson.period.feedback = period.feedback;
  for (const auto& shown : period.demonstrations) {
    lesson.conveyed.insert(lesson.conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
  }
}

void LessonBeliefs::extend(std::size_t s, std::size_t h, std::size_t periods) {
  auto& chain = chains_[s][h];
  const auto& one = options_.hypotheses[h];
  for (std::size_t t = chain.after.size(); t < periods; ++t) {
    const auto& lesson = lessons_[t];
    if (t == 0 || lessons_[t - 1].period.component != lesson.period.component) chain.ability = one.ability;
    const auto& before = t == 0 ? starts_[s] : chain.after[t - 1];
    auto belief = before.belief();
    const auto observe = [&](std::span<const HalfSpace> half_spaces, std::string_view what) {
      belief.observe(
          half_spaces,
          HalfSpaceLikelihood{std::min(chain.ability, detail::kCertain), options_.likelihood, belief.dimension()},
          random_.split(what).split(s).split(h).split(lesson.period.period));
    };
    observe(lesson.conveyed, "watch");
    chain.answering.emplace_back(belief, before);
    const double grown = chain.ability + (one.confirm_gain + one.correct_gain) / 2.0;
    chain.ability = std::max(chain.ability, std::min(grown, detail::kHighestAbility));
    observe(lesson.period.feedback, "feedback");
    chain.after.emplace_back(std::move(belief), chain.answering.back());
  }
}

KnownBelief& LessonBeliefs::answering(std::size_t s, std::size_t h, std::size_t t) {
  extend(s, h, t + 1);
  return chains_[s][h].answering[t];
}

KnownBelief& LessonBeliefs::after(std::size_t s, std::size_t h, std::size_t t) {
  if (t == 0) return starts_[s];
  extend(s, h, t);
  return chains_[s][h].after[t - 1];
}

}  // namespace kith
