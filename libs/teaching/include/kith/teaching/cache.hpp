#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/belief/likelihood.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/teaching/exam.hpp"
#include "kith/teaching/imitation_table.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/lesson.hpp"
#include "kith/teaching/start_sample.hpp"

namespace kith {

class ExamWorth;
struct TeachingOptions;

/// What sessions over one domain compute again and again: regions of constraint sets, what people do and what
/// demonstrations tell them, and the initial points of beliefs.
///
/// A cache in front of pure functions: results never depend on what was asked before, nor on which sessions it served.
/// Sessions keep nothing that refers to it, so it can be trimmed, replaced or destroyed while they live. Not
/// thread-safe; give each thread its own, or hand one on.
///
/// Numbers of constraints and of policy cells are those of this cache and valid until trim().
class TeachingCache {
 public:
  /// Memory that is kept when sessions propose lessons, in bytes, beside the PartitionStore; while a lesson is chosen
  /// it may be more.
  static constexpr std::size_t kDefaultBytes = std::size_t{48} << 20u;
  /// The same for one of so many threads that teach a domain at a time. Where behaviours are planned on demand they
  /// share 192 MB.
  [[nodiscard]] static std::size_t bytes_of_thread(const Atlas& atlas, std::size_t threads);

  /// Keeps the atlas alive, and so do sessions that are made with this cache.
  /// @param store  of the same atlas, shared with the caches of other threads; nothing: one for this cache alone.
  explicit TeachingCache(std::shared_ptr<const Atlas> atlas, std::size_t max_bytes = kDefaultBytes,
                         std::shared_ptr<PartitionStore> store = nullptr)
      : atlas_{std::move(atlas)},
        max_bytes_{max_bytes},
        partitions_{
            std::make_shared<PolicyPartitions>(store ? std::move(store) : std::make_shared<PartitionStore>(*atlas_))},
        known_{std::make_unique<Known>(*atlas_, max_bytes, partitions_)} {}
  /// For an atlas that outlives this cache and all sessions that are made with it.
  explicit TeachingCache(const Atlas& atlas, std::size_t max_bytes = kDefaultBytes,
                         std::shared_ptr<PartitionStore> store = nullptr)
      : TeachingCache{std::shared_ptr<const Atlas>{std::shared_ptr<const Atlas>{}, &atlas}, max_bytes,
                      std::move(store)} {}

  [[nodiscard]] const Atlas& atlas() const noexcept { return *atlas_; }
  [[nodiscard]] const std::shared_ptr<const Atlas>& shared_atlas() const noexcept { return atlas_; }
  [[nodiscard]] Behaviours& behaviours() noexcept { return known_->behaviours; }
  [[nodiscard]] Regions& regions() noexcept { return known_->regions; }
  [[nodiscard]] const ConstraintTable& constraints() const noexcept { return known_->behaviours.constraints(); }
  /// The half-spaces as a set of constraints; those met for the first time are added.
  [[nodiscard]] ConstraintSet numbers_of(std::span<const HalfSpace> half_spaces) {
    return known_->behaviours.numbers_of(half_spaces);
  }

  /// About how much is remembered, in bytes, without the covers.
  [[nodiscard]] std::size_t memory() const noexcept;
  /// Forgets everything but the covers if it takes more than `max_bytes`. Sessions do this before each lesson.
  void trim();

  /// The cover of `prior` by `num_points` points. The reference stays valid as long as this object.
  /// @param known  see PriorCover.
  const PriorCover& cover(const Cone& prior, std::size_t num_points, const std::optional<Cone>& known = {});
  /// Where beliefs about members begin.
  const PriorCover& start_of(const TeachingOptions& options);

  /// The exam of the domain, made when first asked for. The reference stays valid as long as this object.
  const Exam& exam() { return *shared_exam(); }
  /// The same, for those that outlive this object.
  const std::shared_ptr<const Exam>& shared_exam();

  /// Whether people who only take the shortest path get a test wrong: who think that nothing costs anything but the
  /// reference feature. Never where the robot gains by that. Found when first asked for.
  bool is_shortest_wrong(StartIndex test);

  /// What imitating demonstrations comes to in the exam, made when first asked for; until trim().
  ImitationTable& imitation();

  /// What people get right on a component's starts, made when first asked for. The reference stays valid as long as
  /// this object.
  const ExamWorth& worth_of(std::size_t component);

  /// The starts of a component by which a session may stop, and its tests where behaviours are not tabulated; made when
  /// first asked for. The references stay valid as long as this object.
  const std::shared_ptr<const StartSample>& starts_of(std::size_t component);
  const std::shared_ptr<const StartSample>& tests_of(std::size_t component);

 private:
  struct Known {
    Known(const Atlas& atlas, std::size_t max_bytes, std::shared_ptr<PolicyPartitions> partitions)
        : behaviours{atlas, Behaviours::kDefaultCells, max_bytes / 2, std::move(partitions)},
          regions{behaviours.constraints()} {}
    Behaviours behaviours;
    Regions regions;
  };
  std::shared_ptr<const Atlas> atlas_;
  std::size_t max_bytes_;
  std::shared_ptr<PolicyPartitions> partitions_;
  std::unique_ptr<Known> known_;
  std::shared_ptr<const Exam> exam_;
  std::vector<std::optional<bool>> is_shortest_wrong_;  // per start
  std::optional<ImitationTable> imitation_;
  std::vector<std::shared_ptr<const ExamWorth>> worth_;     // per component
  std::vector<std::shared_ptr<const StartSample>> starts_;  // per component
  std::vector<std::shared_ptr<const StartSample>> tests_;   // per component
  std::list<PriorCover> covers_;                            // few: one per prior and filter size of a study
};

}  // namespace kith
