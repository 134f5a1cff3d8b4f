#include "hosted_room.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/sha256.hpp"
#include "kith/store/session_review.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostAhead = 4;  // lessons that are begun ahead of time for each one that is taken
constexpr std::size_t kRunnersUp = 4;  // that a facilitator who looks wants to see besides the chosen demonstrations

}  // namespace

StoredEvent to_stored(std::int64_t room, const RoomEvent& event) {
  return {.room = room,
          .seq = event.seq,
          .at_us = event.at_us,
          .actor = event.actor,
          .type = std::string{event.kind().word},
          .json = body_of(event).dump(),
          .message = {}};
}

std::uint64_t HostedRoom::mark_of(const std::string& actor, const std::string& message) {
  Sha256 hash;
  hash.update(actor);
  hash.update(std::string_view{"\0", 1});
  hash.update(message);
  std::uint64_t mark = 0;
  for (const char c : std::move(hash).digest().substr(0, 8)) mark = mark << 8 | static_cast<unsigned char>(c);
  return mark;
}

std::int64_t HostedRoom::now() const { return std::max(service_.now_us(), last_us_); }

HostedRoom::HostedRoom(ServiceState& service, StoredRoom stored, RoomSetup setup)
    : service_{service}, strand_{service.strands.make()}, stored_{std::move(stored)}, setup_{std::move(setup)} {}

void HostedRoom::post(Strands::Job job) { service_.strands.post(strand_, std::move(job)); }

bool HostedRoom::can_show(const std::string& what, const std::function<void()>& show) {
  std::string problem;
  try {
    show();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (std::exchange(unseen_[what], problem) != problem) service_.views.unseen(*this, what, problem);
  return problem.empty();
}

void HostedRoom::begin() {
  try {
    service_.caches.lend([&](TeachingCache& cache) { room_.emplace(service_.study, setup_, cache); });
  } catch (const std::exception& error) {
    broken_ = error.what();
    service_.views.trouble(number(), "room " + setup_.code + " cannot be used: " + broken_);
  }
  has_changed_ = true;
  advance();
}

void HostedRoom::rebuild(std::vector<StoredEvent> events) {
  service_.teachers.post(TeachingPool::Urgency::kNow,
                         [self = shared_from_this(), events = std::move(events)](TeachingCache& cache) {
                           Rebuilt result;
                           std::int64_t last = 0;

                           // A room that does not replay is kept as it is stored, and says why it stands still.
                           try {
                             Room rebuilt{self->service_.study, self->setup_, cache};
                             for (const auto& event : events) {
                               rebuilt.apply(room_event_of(event), cache);
                               result.taught.see(rebuilt);
                               if (event.message) result.messages.push_back(mark_of(event.actor, *event.message));
                               last = event.at_us;
                             }
                             release(rebuilt, result.taught, result.observed);
                             result.room = std::move(rebuilt);
                           } catch (const std::exception& error) {
                             result.problem = error.what();
                           }

                           self->post([self, result = std::move(result), last]() mutable {
                             self->last_us_ = last;
                             self->finish_rebuild(std::move(result));
                           });
                         });
}

void HostedRoom::finish_rebuild(Rebuilt rebuilt) {
  room_ = std::move(rebuilt.room);
  taught_ = std::move(rebuilt.taught);
  observed_ = std::move(rebuilt.observed);
  messages_ = std::move(rebuilt.messages);
  std::sort(messages_.begin(), messages_.end());
  if (!room_) {
    broken_ = rebuilt.problem;
    service_.views.trouble(number(), "room " + setup_.code + " cannot be rebuilt: " + broken_);
  }
  has_changed_ = true;
  if (room_) service_.on_applied(*this, {});
  if (!room_ || now() - last_us_ < kSecond) return advance();

  // Nobody's time went by while the server was stopped. When that was is not known better than by the last event.
  const Json why{{"reason", "The server was stopped."}};
  auto halt = room_->decide({.actor = "server", .type = "pause", .body = why, .id = {}}, last_us_).events;
  if (halt.empty()) return advance();
  halt.push_back({halt.back().seq + 1, now(), "server", happening::Resumed{why["reason"]}});
  save({.events = std::move(halt)});
}

void HostedRoom::ask(RoomCommand command, Done done, StoreBatch with) {
  asked_.push_back({.command = std::move(command), .done = std::move(done), .with = std::move(with)});
  advance();
}

void HostedRoom::wake() {
  if (saving_ && saving_->has_failed) {
    saving_->has_failed = false;
    hand_in();
    return;
  }
  advance();
}

void HostedRoom::abandon() {
  asked_.clear();
  saving_.reset();
}

void HostedRoom::advance() {
  do_what_can_be_done();
  const auto ahead = std::count_if(lessons_.begin(), lessons_.end(), [](const auto& entry) { return entry.second; });
  const auto sessions = static_cast<std::size_t>(ahead) + (room_ && room_->holds_session() ? 1 : 0);
  service_.num_sessions += sessions - std::exchange(num_sessions_, sessions);
}

// Until something is being saved or nothing is left.
void HostedRoom::do_what_can_be_done() {
  if (!broken_.empty()) {
    may_have_free_seat_ = false;
    for (auto& asked : std::exchange(asked_, {}))
      asked.done({.events = {}, .refusal = Refusal{"room-broken", "This group cannot continue: " + broken_}});
    next_due_us_ = std::numeric_limits<std::int64_t>::max();
    return;
  }
  if (!room_) return;
  may_have_free_seat_ = room_->has_free_seat();
  while (!saving_ && begin_next()) {
  }
  if (saving_) return;
  if (setup_.is_waiting_list) {
    constexpr auto kNever = std::numeric_limits<std::int64_t>::max();
    next_due_us_ = std::min(room_->next_due().value_or(kNever), room_->last_call().value_or(kNever));
    return service_.waiting.form_group(*this);
  }
  seek_lesson();
  if (saving_) return;
  if (std::exchange(has_changed_, false)) look_ahead();
  next_due_us_ = room_->next_due().value_or(std::numeric_limits<std::int64_t>::max());
}

// Takes up the next command or what is due by the clock. @return false if there is neither.
bool HostedRoom::begin_next() {
  if (auto due = room_->due(now()); !due.empty()) {
    save({.events = std::move(due)});
    return true;
  }
  if (asked_.empty()) return false;
  auto asked = std::move(asked_.front());
  asked_.pop_front();
  const auto& id = asked.command.id;
  if (!id.empty() && std::binary_search(messages_.begin(), messages_.end(), mark_of(asked.command.actor, id))) {
    asked.done({});
    return true;
  }
  auto decision = room_->decide(asked.command, now());
  if (decision.refusal || decision.events.empty()) {
    // What changed nothing must not do so later, when it is sent again behind something that was sent after it.
    if (!decision.refusal && !id.empty()) keep_mark(mark_of(asked.command.actor, id));
    asked.done({.events = {}, .refusal = std::move(decision.refusal)});
    return true;
  }
  save({.events = std::move(decision.events),
        .message = id,
        .done = std::move(asked.done),
        .with = std::move(asked.with)});
  return true;
}

void HostedRoom::save(Saving saving) {
  saving_ = std::move(saving);
  hand_in();
}

void HostedRoom::hand_in() {
  auto batch = saving_->with;
  for (const auto& event : saving_->events) batch.events.push_back(to_stored(number(), event));
  if (!saving_->message.empty()) batch.events.back().message = saving_->message;
  service_.save(std::move(batch),
                [self = shared_from_this()](bool saved) { self->post([self, saved] { self->on_saved(saved); }); });
}

void HostedRoom::on_saved(bool saved) {
  if (!saved) {
    saving_->has_failed = true;
    is_unsaved_ = true;
    return;
  }

  is_unsaved_ = false;
  const auto done = std::exchange(saving_, std::nullopt);
  try {
    service_.caches.lend([&](TeachingCache& cache) {
      for (const auto& event : done->events) {
        room_->apply(event, cache, event.get<happening::LessonChosen>() != nullptr ? done->lesson.get() : nullptr);
        taught_.see(*room_);
        has_changed_ = has_changed_ || event.kind().changes_lessons;
        last_us_ = event.at_us;
      }
    });
  } catch (const std::exception& error) {
    broken_ = error.what();
    service_.views.trouble(number(), "room " + setup_.code + " stopped: " + broken_);
  }

  // With a lesson chosen, what was chosen ahead in its place is of no use.
  if (done->lesson) {
    lessons_.clear();
    wanted_.clear();
    num_ahead_ = 0;
  }

  if (!done->message.empty()) keep_mark(mark_of(done->events.back().actor, done->message));
  release();

  if (done->done) done->done({.events = done->events, .refusal = {}});
  service_.on_applied(*this, done->events);
  advance();
}

void HostedRoom::release(Room& room, const TaughtPeople& taught, std::vector<TaughtPerson>& observed) {
  const auto before = room;
  room.release();
  if (!room.holds_session() && before.holds_session() && taught.num_periods() > 0) observed = taught.all(before);
}

std::size_t HostedRoom::num_observed() const {
  auto sum = taught_.num_periods();
  for (std::size_t seat = 1; room_ && seat <= room_->num_seats(); ++seat) sum += room_->exam_of(seat).size();
  return sum;
}

// A room whose group is not taught any more stays for its pages; what only teaching needs does not.
void HostedRoom::release() {
  if (!room_->holds_session()) return;
  release(*room_, taught_, observed_);
  if (room_->holds_session()) return;
  lessons_.clear();
  wanted_.clear();
}

void HostedRoom::keep_mark(std::uint64_t mark) {
  messages_.insert(std::upper_bound(messages_.begin(), messages_.end(), mark), mark);
}

// Asks for the lesson that the room waits for, or takes it if it is there.
void HostedRoom::seek_lesson() {
  if (std::exchange(sought_, room_->seq() + 1) != room_->seq() + 1) {
    const auto task = room_->teaching();
    const auto key = task ? task->key() : std::string{};
    const bool is_new = key != std::exchange(wanted_, key);
    const auto found = lessons_.find(key);
    const bool is_there = found != lessons_.end() && found->second;
    if (task && is_new && !is_there) start_task(TeachingPool::Urgency::kNow, *task);
  }
  const auto found = lessons_.find(wanted_);
  if (wanted_.empty() || found == lessons_.end() || !found->second) return;
  const auto lesson = found->second;
  save({.events = {room_->taught(*lesson, now())}, .lesson = lesson});
}

void HostedRoom::look_ahead() {
  if (room_->stage() != RoomStage::kRunning || !wanted_.empty()) return;
  const auto likely = room_->likely_teaching();
  // A lesson that is no longer likely is not kept: it holds a session.
  std::erase_if(lessons_, [&](const auto& entry) {
    return std::none_of(likely.begin(), likely.end(), [&](const auto& task) { return task.key() == entry.first; });
  });
  for (const auto& task : likely) {
    if (num_ahead_ >= kMostAhead) return;
    if (lessons_.find(task.key()) != lessons_.end()) continue;
    ++num_ahead_;
    start_task(TeachingPool::Urgency::kAhead, task);
  }
}

void HostedRoom::start_task(TeachingPool::Urgency urgency, const TeachingTask& task) {
  lessons_.emplace(task.key(), nullptr);
  const auto runners_up = num_watchers > 0 ? kRunnersUp : 0;
  service_.teachers.post(urgency, [self = shared_from_this(), task, runners_up](TeachingCache& cache) {
    std::shared_ptr<const TaughtLesson> lesson;
    std::string problem;
    const auto choose = [&](std::size_t others) {
      try {
        lesson = std::make_shared<const TaughtLesson>(task.run(cache, others));
      } catch (const std::exception& error) {
        problem = error.what();
      }
    };

    // Nobody is taught otherwise because somebody looks.
    choose(runners_up);
    if (!lesson && runners_up > 0) choose(0);
    self->post([self, lesson, problem] {
      const auto* what = lesson ? " does not tell what else could be shown: " : " cannot be taught: ";
      if (!problem.empty()) self->service_.views.trouble(self->number(), "room " + self->setup_.code + what + problem);
      if (lesson) return self->on_lesson(lesson);
      self->broken_ = problem;
      self->advance();
    });
  });
}

void HostedRoom::on_lesson(std::shared_ptr<const TaughtLesson> lesson) {
  const auto found = lessons_.find(lesson->key);
  if (found == lessons_.end() && lesson->key != wanted_) return;  // no longer needed
  lessons_[lesson->key] = std::move(lesson);
  advance();
}

}  // namespace kith
