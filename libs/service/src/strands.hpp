#pragma once

#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <cstddef>
#include <deque>
#include <functional>
#include <utility>

#include "busy_count.hpp"
#include "net.hpp"
#include "threads.hpp"

namespace kith {

using Strand = asio::strand<asio::io_context::executor_type>;

// Threads that do jobs: those of one strand one at a time and in the order in which they came, those of different
// strands at the same time. Whatever a part of the service owns is touched by jobs of its strand only.
class Strands {
 public:
  using Job = std::function<void()>;

  Strands(std::size_t threads, BusyCount& busy) : busy_{busy}, threads_{threads} {}

  [[nodiscard]] Strand make() { return asio::make_strand(threads_.io()); }
  // From any thread, jobs included. Jobs must not throw.
  void post(const Strand& strand, Job job) { asio::post(strand, busy_.during(std::move(job))); }
  // Drops what has not begun.
  void stop() { threads_.stop(); }

 private:
  BusyCount& busy_;
  Threads threads_;
};

// Lets jobs of one strand that wait for others take turns: the next one begins when the one before has said that it has
// ended.
class Turns {
 public:
  void take(Strands::Job job) {
    waiting_.push_back(std::move(job));
    begin();
  }
  void end() {
    is_taken_ = false;
    begin();
  }

 private:
  void begin() {
    if (is_taken_ || waiting_.empty()) return;
    is_taken_ = true;
    const auto job = std::move(waiting_.front());
    waiting_.pop_front();
    job();
  }

  bool is_taken_ = false;
  std::deque<Strands::Job> waiting_;
};

}  // namespace kith
