#include "teaching_pool.hpp"

#include <utility>

namespace kith {
namespace {

constexpr std::size_t kMostWaiting = 64;  // each keeps a copy of a session

}  // namespace

void TeachingPool::stop() {
  {
    const std::lock_guard lock{mutex_};
    is_stopping_ = true;
    for (auto left = now_.size() + ahead_.size(); left > 0; --left) busy_.end();
    now_.clear();
    ahead_.clear();
  }
  threads_.stop();
}

void TeachingPool::post(Urgency urgency, Job job) {
  {
    const std::lock_guard lock{mutex_};
    if (is_stopping_) return;
    auto& queue = urgency == Urgency::kNow ? now_ : ahead_;
    busy_.begin();
    queue.push_back(std::move(job));
    if (urgency == Urgency::kAhead && ahead_.size() > kMostWaiting) {
      ahead_.pop_front();
      busy_.end();
    }
  }
  asio::post(threads_.io(), [this] { do_next(); });
}

void TeachingPool::do_next() {
  Job job;
  {
    const std::lock_guard lock{mutex_};
    auto& queue = now_.empty() ? ahead_ : now_;
    if (queue.empty()) return;
    job = std::move(queue.front());
    queue.pop_front();
  }
  caches_.lend(job);
  job = nullptr;
  busy_.end();
}

}  // namespace kith
