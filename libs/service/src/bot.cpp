#include "bot.hpp"

#include <algorithm>
#include <utility>

#include "kith/live/room_event.hpp"

namespace kith {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kBotTick{1000};
constexpr int kTicksPerBeat = 5;
constexpr std::chrono::seconds kAgain{5};  // after which something that is still asked for is done once more

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Bot::Bot(asio::io_context& io, BotWorld& world, std::shared_ptr<BotGroup> group, std::string token, std::uint64_t seed)
    : world_{world},
      group_{std::move(group)},
      token_{std::move(token)},
      random_{seed},
      id_prefix_{random_prefix()},
      strand_{asio::make_strand(io)},
      thinking_{strand_},
      connecting_{strand_},
      ticking_{strand_} {}

void Bot::start() {
  asio::post(strand_, [self = shared_from_this()] {
    // Spread over a second: a class does not click at once either.
    self->reconnect_in(milliseconds{static_cast<int>(1000.0 * self->uniform())});
    self->tick();
  });
}

void Bot::stop() {
  asio::post(strand_, [self = shared_from_this()] { self->finish(); });
}

double Bot::uniform() { return std::uniform_real_distribution<double>{0.0, 1.0}(random_); }

milliseconds Bot::time_for(double pace) {
  const double mean = pace * static_cast<double>(world_.options.answer_every.count());
  return milliseconds{static_cast<std::int64_t>(mean * (0.5 + uniform()))};
}

void Bot::connect() {
  if (is_finished_) return;
  is_welcome_ = false;
  const std::weak_ptr<Bot> weak = weak_from_this();
  const auto with_self = [weak](auto what) {
    return [weak, what](auto... arguments) {
      if (const auto self = weak.lock()) what(*self, arguments...);
    };
  };
  socket_ = std::make_shared<ClientSocket>(
      strand_, ClientSocket::Handlers{with_self([](Bot& bot) { bot.on_open(); }),
                                      with_self([](Bot& bot, std::string_view text) { bot.on_text(text); }),
                                      with_self([](Bot& bot) { bot.on_lost(); })});
  socket_->connect(world_.server);
}

void Bot::on_open() { socket_->send(Json{{"t", "hello"}, {"v", 1}, {"token", token_}, {"tab", id_prefix_}}.dump()); }

void Bot::on_text(std::string_view text) {
  const auto frame = Json::parse(text, nullptr, false);
  if (!frame.is_object()) return;
  const auto type = frame.value("t", "");
  if (type == "welcome") {
    attempts_ = 0;
    is_welcome_ = true;
    transmit();
  } else if (type == "view" && frame.contains("view")) {
    on_view(frame["view"]);
  } else if (type == "ack" || type == "nak") {
    on_reply(frame, type == "ack");
  } else if (type == "bye") {
    record_.stage = "bye: " + frame.value("reason", "");
  }
}

void Bot::on_view(Json view) {
  if (lost_at_ != Clock::time_point{}) {
    record_.reconnects.push_back(milliseconds_since(lost_at_));
    lost_at_ = {};
  }
  view_ = std::move(view);
  record_.stage = view_.value("stage", "");
  if (is_last_stage(record_.stage)) return finish();
  note_next_lesson();
  consider();
}

// The time that a group waits between the last "continue" and its next demonstration.
void Bot::note_next_lesson() {
  if (record_.stage != "watch") return;
  const auto act = act_for(view_);
  if (!act || act->body.value("demo", -1) != 0 || act->key == lesson_key_) return;
  lesson_key_ = act->key;
  if (!std::exchange(has_continued_, false)) return;
  const Clock::time_point since{std::chrono::nanoseconds{group_->last_continue_ns.load()}};
  record_.next_lessons.push_back(std::max(0.0, milliseconds_since(since)));
}

void Bot::on_reply(const Json& frame, bool is_accepted) {
  if (!pending_ || frame.value("id", "") != pending_->id) return;
  if (is_accepted) {
    ++record_.messages;
    if (!pending_->is_resent) record_.acknowledgements.push_back(milliseconds_since(pending_->sent));
    if (pending_->is_answer) record_.answers.push_back(pending_->id);
  } else {
    ++record_.refusals[frame.value("reason", "unknown")];
  }
  done_key_ = pending_->key;
  done_at_ = Clock::now();
  pending_.reset();
  consider();
}

void Bot::on_lost() {
  is_welcome_ = false;
  ++record_.connections_lost;
  const int doublings = std::min(attempts_++, 4);
  reconnect_in(milliseconds{static_cast<int>(500.0 * static_cast<double>(1 << doublings) * (0.5 + uniform()))});
}

void Bot::lose_connection() {
  if (!socket_) return;
  is_welcome_ = false;
  socket_->cut();
  ++record_.num_reconnects;
  reconnect_in(milliseconds{100 + static_cast<int>(900.0 * uniform())});
}

void Bot::reconnect_in(milliseconds time) {
  connecting_.expires_after(time);
  connecting_.async_wait([self = shared_from_this()](NetError error) {
    if (error || self->is_finished_) return;
    if (!self->view_.is_null()) self->lost_at_ = Clock::now();
    self->connect();
  });
}

void Bot::consider() {
  if (is_finished_ || pending_ || is_thinking_) return;
  const auto next = act_for(view_);
  if (!next || next->key == done_key_) return;
  is_thinking_ = true;
  thinking_.expires_after(time_for(next->pace));
  thinking_.async_wait([self = shared_from_this()](NetError error) {
    if (!error) self->act();
  });
}

// What is asked for may have changed meanwhile.
void Bot::act() {
  is_thinking_ = false;
  if (is_finished_ || pending_) return;
  auto next = act_for(view_);
  if (!next || next->key == done_key_) return;
  if (!next->world.empty()) {
    const auto path = path_for(*next);
    next->body["actions"] = path.actions;
    if (path.for_ever) next->body["for_ever"] = true;
    auto keys = Json::array();
    int at = 0;
    for (const int action : path.actions) keys.push_back({action, at += 150});
    next->body["keys"] = std::move(keys);
    next->body["ms"] = at;
  }
  send(*std::move(next));
}

// A wrong answer stops one step too early.
AnswerPath Bot::path_for(const BotAct& act) {
  const auto& right = world_.options.right_path;
  auto path = (right ? right(act.world, act.start) : std::nullopt).value_or(AnswerPath{});
  if (uniform() < world_.options.right || path.actions.empty()) return path;
  path.actions.pop_back();
  path.for_ever = false;
  return path;
}

void Bot::send(BotAct act) {
  Pending message;
  message.id = id_prefix_ + std::to_string(next_id_++);
  message.frame = Json{{"t", act.type}, {"id", message.id}, {"body", std::move(act.body)}}.dump();
  message.key = act.key;
  message.is_answer = act.type == happening::Answered::kKind.command;
  message.is_continue = act.type == happening::Continued::kKind.command;
  pending_ = std::move(message);
  transmit();
}

// Sends the message that waits for an answer, again if need be. Until the bot is connected, it waits.
void Bot::transmit() {
  if (!pending_ || !is_welcome_) return;
  pending_->is_resent = pending_->sent != Clock::time_point{};
  if (!pending_->is_resent) pending_->sent = Clock::now();
  if (pending_->is_continue && !pending_->is_resent) {
    has_continued_ = true;
    group_->last_continue_ns = pending_->sent.time_since_epoch().count();
  }
  socket_->send(pending_->frame);
}

void Bot::tick() {
  if (is_finished_) return;
  ++ticks_;
  if (ticks_ % kTicksPerBeat == 0 && is_welcome_) socket_->send(R"({"t":"beat"})");
  if (uniform() < world_.options.reconnects) lose_connection();
  if (!pending_ && !is_thinking_ && !done_key_.empty() && Clock::now() - done_at_ > kAgain) {
    done_key_.clear();
    consider();
  }
  ticking_.expires_after(kBotTick);
  ticking_.async_wait([self = shared_from_this()](NetError error) {
    if (!error) self->tick();
  });
}

void Bot::finish() {
  if (is_finished_) return;
  is_finished_ = true;
  record_.waits_for_answer = pending_.has_value();
  thinking_.cancel();
  connecting_.cancel();
  ticking_.cancel();
  if (socket_) socket_->cut();
  // A long rehearsal has many people who have finished: only their records are kept.
  socket_.reset();
  view_ = {};
  pending_.reset();
  --group_->unfinished;
  --world_.unfinished;
}

}  // namespace kith
