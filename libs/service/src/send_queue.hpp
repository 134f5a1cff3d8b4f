#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <utility>

namespace kith {

/// Frames that wait for a client, as many as a limit allows. A single frame is accepted however long it is.
class SendQueue {
 public:
  using Frame = std::shared_ptr<const std::string>;

  SendQueue(std::size_t max_frames, std::size_t max_bytes) : max_frames_{max_frames}, max_bytes_{max_bytes} {}

  /// @return false if the queue is full: it is then empty, and stays so.
  [[nodiscard]] bool push(Frame frame) {
    if (is_overflown_) return false;
    if (!frames_.empty() && (frames_.size() >= max_frames_ || bytes_ + frame->size() > max_bytes_)) {
      is_overflown_ = true;
      frames_.clear();
      bytes_ = 0;
      return false;
    }
    bytes_ += frame->size();
    frames_.push_back(std::move(frame));
    return true;
  }

  /// The next frame to send, or null.
  [[nodiscard]] Frame pop() {
    if (frames_.empty()) return nullptr;
    auto frame = std::move(frames_.front());
    frames_.pop_front();
    bytes_ -= frame->size();
    return frame;
  }

  [[nodiscard]] bool is_overflown() const { return is_overflown_; }

 private:
  std::size_t max_frames_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  bool is_overflown_ = false;
  std::deque<Frame> frames_;
};

}  // namespace kith
