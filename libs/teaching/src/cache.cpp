#include "kith/teaching/cache.hpp"

#include <algorithm>

#include "kith/domains/judgement.hpp"
#include "kith/teaching/exam_worth.hpp"
#include "kith/teaching/teaching_options.hpp"

namespace kith {

std::size_t TeachingCache::memory() const noexcept {
  return known_->behaviours.memory() + known_->regions.memory() + (imitation_ ? imitation_->memory() : 0);
}

std::size_t TeachingCache::bytes_of_thread(const Atlas& atlas, std::size_t threads) {
  constexpr std::size_t kShared = std::size_t{192} << 20u;
  constexpr std::size_t kLeast = std::size_t{2} << 20u;
  if (atlas.find_tables()) return kDefaultBytes;
  return std::clamp(kShared / std::max<std::size_t>(threads, 1), kLeast, kDefaultBytes);
}

void TeachingCache::trim() {
  const bool renews = partitions_->is_outdated();
  if (memory() <= max_bytes_ && !renews) return;
  known_.reset();  // first, so that both are never held
  imitation_.reset();
  if (renews) partitions_->renew();
  known_ = std::make_unique<Known>(*atlas_, max_bytes_, partitions_);
}

const PriorCover& TeachingCache::cover(const Cone& prior, std::size_t num_points, const std::optional<Cone>& known) {
  const auto place = std::find_if(covers_.begin(), covers_.end(), [&](const PriorCover& cover) {
    return cover.size() == num_points && cover.prior() == prior && cover.known() == known;
  });
  return place != covers_.end() ? *place : covers_.emplace_back(prior, num_points, atlas_->feature_order(), known);
}

const PriorCover& TeachingCache::start_of(const TeachingOptions& options) {
  return cover(atlas_->prior_cone(), options.filter.particles, options.known);
}

const std::shared_ptr<const Exam>& TeachingCache::shared_exam() {
  constexpr std::size_t kPriorPoints = 1000;  // to find out how difficult starts are
  if (!exam_) exam_ = std::make_shared<const Exam>(behaviours(), cover(atlas_->prior_cone(), kPriorPoints));
  return exam_;
}

bool TeachingCache::is_shortest_wrong(StartIndex test) {
  is_shortest_wrong_.resize(atlas_->num_states());
  auto& known = is_shortest_wrong_[test.value()];
  if (known) return *known;
  const auto& domain = atlas_->domain();
  const auto reference = reference_feature(domain, atlas_->knowledge_components());
  known = false;
  if (domain.weights().integer[reference] >= 0) return *known;
  const auto only =
      -Eigen::VectorXd::Unit(static_cast<Eigen::Index>(domain.num_features()), static_cast<Eigen::Index>(reference));
  const auto& robot = atlas_->feature_counts(test);
  const auto shortest = behaviours().answer(test, behaviours().locate(Direction{only}));
  // Who is shorter by anything: of equally short paths people may take any.
  known = shortest && (*shortest)[reference] < robot[reference] && !judge_path(domain, robot, *shortest).is_right;
  return *known;
}

ImitationTable& TeachingCache::imitation() {
  if (!imitation_) imitation_.emplace(*atlas_, exam());
  return *imitation_;
}

const ExamWorth& TeachingCache::worth_of(std::size_t component) {
  constexpr std::size_t kPriorPoints = 1000;
  worth_.resize(atlas_->knowledge_components().size());
  auto& known = worth_.at(component);
  if (!known)
    known =
        std::make_shared<const ExamWorth>(behaviours(), exam(), cover(atlas_->prior_cone(), kPriorPoints), component);
  return *known;
}

const std::shared_ptr<const StartSample>& TeachingCache::starts_of(std::size_t component) {
  starts_.resize(atlas_->knowledge_components().size());
  auto& known = starts_.at(component);
  if (!known) known = std::make_shared<const StartSample>(StartSample::spread_over_starts(*atlas_, component));
  return known;
}

const std::shared_ptr<const StartSample>& TeachingCache::tests_of(std::size_t component) {
  tests_.resize(atlas_->knowledge_components().size());
  auto& known = tests_.at(component);
  if (!known) known = std::make_shared<const StartSample>(StartSample::spread_over_facets(*atlas_, component));
  return known;
}

}  // namespace kith
