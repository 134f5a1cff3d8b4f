#include "kith/study/study_memory.hpp"

#include <algorithm>
#include <string>

#include "kith/core/memory.hpp"
#include "kith/core/parallel_loop.hpp"

namespace kith {
namespace {

constexpr std::uint64_t kTeam = 700;       // a record without its members
constexpr std::uint64_t kMember = 250;     // one of them at the end
constexpr std::uint64_t kPeriod = 1'500;   // a period with its lesson, tests and feedback
constexpr std::uint64_t kAnswers = 1'000;  // what one member answered in a period
constexpr std::uint64_t kPeriods = 20;     // of most sessions at most
constexpr std::uint64_t kNumber = 8;

// Particles of all beliefs about a team and of its members themselves.
std::uint64_t num_particles(const StudySpec& spec, const std::string& composition) {
  std::uint64_t sum = (composition.size() + 2) * spec.teaching.filter.particles;  // of each, common and joint
  for (const char letter : composition) {
    const auto& type = learner_type(spec, letter);
    std::uint64_t most = type.mixture.empty() ? num_particles(type.parameters) : 0;
    for (const auto& part : type.mixture) {
      most = std::max<std::uint64_t>(most, num_particles(learner_type(spec, part.letter).parameters));
    }
    sum += most;
  }
  return sum;
}

std::uint64_t record_of(const StudySpec& spec, const std::string& composition) {
  const auto periods = std::min<std::uint64_t>(kPeriods, spec.teaching.max_periods);
  std::uint64_t sum = kTeam + kMember * composition.size();
  if (spec.record != RecordLevel::kTeam) sum += periods * (kPeriod + kAnswers * composition.size());
  if (spec.record == RecordLevel::kParticles)
    sum += periods * num_particles(spec, composition) * (spec.num_features + 1) * kNumber;
  return sum;
}

// Points, weights and their logarithms; an update needs half as much again.
std::uint64_t beliefs_of(const StudySpec& spec, const std::string& composition) {
  return 3 * num_particles(spec, composition) * (spec.num_features + 2) * kNumber / 2;
}

template <typename Size>
std::uint64_t largest(const Study& study, const Size& size) {
  std::uint64_t most = 0;
  for (const auto& spec : study.variants) {
    for (const auto& composition : spec.compositions) most = std::max(most, size(spec, composition));
  }
  return most;
}

}  // namespace

std::uint64_t memory_per_team(const Study& study) { return largest(study, record_of); }

std::uint64_t memory_per_thread(const Study& study) {
  return largest(study, [](const StudySpec& spec, const std::string& composition) {
    return beliefs_of(spec, composition) + record_of(spec, composition);
  });
}

void require_study_memory(const Study& study, std::size_t threads, std::size_t kept) {
  const auto how_many = threads == 0 ? default_num_workers() : threads;
  const auto bytes = how_many * memory_per_thread(study) + kept * memory_per_team(study);
  auto what = "teaching on " + std::to_string(how_many) + (how_many == 1 ? " thread" : " threads");
  if (kept > 0) what = "keeping " + std::to_string(kept) + " teams and " + what;
  require_memory(bytes, what,
                 kept > 0 ? "use fewer teams, particles or threads"
                          : "use fewer particles, threads (-j) or members, or record.level = \"period\"");
}

}  // namespace kith
