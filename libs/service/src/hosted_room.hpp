#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/live/room.hpp"
#include "kith/live/taught_people.hpp"
#include "kith/store/event_file.hpp"
#include "seat_pages.hpp"
#include "strands.hpp"
#include "teaching_pool.hpp"

namespace kith {

struct ServiceState;

// What became of a command: events that are on the disk, or a refusal; neither if it was accepted before.
struct CommandOutcome {
  std::vector<RoomEvent> events;
  std::optional<Refusal> refusal;
};

// As it is kept.
[[nodiscard]] StoredEvent to_stored(std::int64_t room, const RoomEvent& event);

// A room on the server. Decides one command at a time, has its events saved, applies them, and only then tells anybody;
// has lessons chosen. All functions but those marked are called on the room's strand.
class HostedRoom : public std::enable_shared_from_this<HostedRoom> {
 public:
  using Done = std::function<void(const CommandOutcome& outcome)>;

  HostedRoom(ServiceState& service, StoredRoom stored, RoomSetup setup);

  // From any thread.
  [[nodiscard]] std::int64_t number() const noexcept { return stored_.number; }
  [[nodiscard]] const RoomSetup& setup() const noexcept { return setup_; }
  // From any thread: when the clock demands something, in microseconds.
  [[nodiscard]] std::int64_t next_due_us() const noexcept { return next_due_us_.load(); }
  // From any thread: whether somebody may find a seat; as long as nobody knows, yes.
  [[nodiscard]] bool may_have_free_seat() const noexcept { return may_have_free_seat_.load(); }
  // From any thread: whether events wait for a disk that refused them.
  [[nodiscard]] bool is_unsaved() const noexcept { return is_unsaved_.load(); }
  // From any thread: how many facilitators look at it.
  std::atomic<int> num_watchers = 0;
  // From any thread: has something done on its strand.
  void post(Strands::Job job);

  // A new room.
  void begin();
  // From any thread: rebuilds it from what is stored, on a thread of the teaching pool. Commands wait meanwhile.
  void rebuild(std::vector<StoredEvent> events);

  // Nothing while it is being rebuilt, or if it could not be.
  [[nodiscard]] const Room* room() const noexcept { return room_ ? &*room_ : nullptr; }
  [[nodiscard]] ServiceState& service() const noexcept { return service_; }
  [[nodiscard]] SeatPages& pages() noexcept { return pages_; }
  // Shows something of the room to whoever looks. If that fails facilitators read why, and the room goes on.
  bool can_show(const std::string& what, const std::function<void()>& show);
  // Has a command decided. `id` of the command may be empty. What is in the batch is saved together with the events
  // that the command leads to, or not at all.
  void ask(RoomCommand command, Done done, StoreBatch with = {});
  // What can be observed of everybody who was taught, for audits, and of how many periods.
  [[nodiscard]] std::vector<TaughtPerson> observed() const {
    return room_->holds_session() ? taught_.all(*room_) : observed_;
  }
  // How much there is to judge people by: periods, and boards of exams.
  [[nodiscard]] std::size_t num_observed() const;
  // The time of what happens now: never before that of the last event.
  [[nodiscard]] std::int64_t now() const;
  // Something may be due by the clock, or could not be saved and is to be tried again.
  void wake();
  // The service has stopped: drops commands that wait, unanswered. Their answers may hold this room.
  void abandon();

 private:
  struct Asked {
    RoomCommand command;
    Done done;
    StoreBatch with;
  };
  // Events on their way to the disk. `message` is the id of the message that led to the last one.
  struct Saving {
    std::vector<RoomEvent> events;
    std::string message{};
    Done done{};
    std::shared_ptr<const TaughtLesson> lesson{};
    StoreBatch with{};
    bool has_failed = false;
  };

  // What there is of a room, and who was taught in it.
  struct Rebuilt {
    std::optional<Room> room;
    TaughtPeople taught;
    std::vector<TaughtPerson> observed;
    std::vector<std::uint64_t> messages;
    std::string problem;
  };
  void finish_rebuild(Rebuilt rebuilt);
  // Releases a room, keeping what audits need.
  static void release(Room& room, const TaughtPeople& taught, std::vector<TaughtPerson>& observed);
  void advance();
  void do_what_can_be_done();
  void release();
  void keep_mark(std::uint64_t mark);
  [[nodiscard]] bool begin_next();
  void save(Saving saving);
  void hand_in();
  void on_saved(bool saved);
  void seek_lesson();
  void look_ahead();
  void start_task(TeachingPool::Urgency urgency, const TeachingTask& task);
  void on_lesson(std::shared_ptr<const TaughtLesson> lesson);
  [[nodiscard]] static std::uint64_t mark_of(const std::string& actor, const std::string& message);

  ServiceState& service_;
  Strand strand_;
  StoredRoom stored_;
  RoomSetup setup_;
  SeatPages pages_{};
  std::atomic<std::int64_t> next_due_us_ = std::numeric_limits<std::int64_t>::max();
  std::atomic<bool> is_unsaved_ = false;
  std::atomic<bool> may_have_free_seat_ = true;

  std::map<std::string, std::string> unseen_;  // why something of it cannot be shown
  std::size_t num_sessions_ = 0;               // in memory, those of lessons that were chosen ahead of time included
  std::optional<Room> room_;
  TaughtPeople taught_;
  std::vector<TaughtPerson> observed_;   // once the session is released
  std::string broken_;                   // why it cannot go on
  std::int64_t last_us_ = 0;             // of the last event
  std::vector<std::uint64_t> messages_;  // whose effects are saved; sorted
  std::deque<Asked> asked_;
  std::optional<Saving> saving_;
  std::uint64_t sought_ = 0;  // one more than the number of the event after which a lesson was last asked for
  std::string wanted_;        // key of the lesson that is waited for
  std::map<std::string, std::shared_ptr<const TaughtLesson>> lessons_;  // by key; null: somebody is at it
  std::size_t num_ahead_ = 0;  // lessons that were begun ahead of time since the last one was taken
  bool has_changed_ = false;   // so that other lessons are likely
};

}  // namespace kith
