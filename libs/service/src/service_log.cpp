#include "service_log.hpp"

#include <utility>

#include "kith/store/json_members.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

// Why something happened that no facilitator gave a reason for.
std::string reason_for(const std::string& type, const Json& body) {
  if (type == "returned") return "followed the join link again: back in room " + text_at(body, "room");
  const auto by = count_at(body, "by");
  if ((type != happening::Dropped::kKind.word && type != happening::Left::kKind.word) || by == 0)
    return text_at(body, "reason");
  return "a simulated learner takes over as seat " + std::to_string(by);
}

}  // namespace

bool is_logged(std::string_view actor, std::string_view type) {
  if (actor == "facilitator") return true;
  const auto* kind = room_event_kind(type);
  if (kind != nullptr) return kind->is_logged;
  return type == "turned-away" || type == "returned" || type == "room-make" || type == "redacted";  // of the service
}

LogEntry log_entry(std::int64_t room, std::int64_t at_us, const std::string& actor, const std::string& type,
                   const Json& body) {
  LogEntry entry{
      .at_us = at_us, .room = room == 0 ? std::string{} : room_id(room), .actor = actor, .what = type, .reason = {}};
  if (!body.is_object()) return entry;
  entry.reason = reason_for(type, body);
  const auto seat = body.find("seat");
  const bool is_about_seat = actor == "server" && seat != body.end() && seat->is_number_integer();
  if (is_about_seat) entry.actor = seat_actor(seat->get<std::size_t>());
  return entry;
}

void ServiceLog::load(const StoredEvent& event) {
  next_seq_ = event.seq + 1;
  if (event.message) seen_.insert(*event.message);
}

void ServiceLog::record(StoreBatch batch, const std::string& actor, const std::string& type, const Json& body,
                        const std::string& message, std::function<void(bool saved)> done) {
  StoredEvent event{.actor = actor, .type = type, .json = body.dump()};
  if (!message.empty()) event.message = message;
  batch.events.insert(batch.events.begin(), std::move(event));
  turns_.take([this, batch = std::move(batch), body, done = std::move(done)]() mutable {
    auto& own = batch.events.front();
    own.seq = next_seq_;
    own.at_us = service_.now_us();
    const auto entry = log_entry(0, own.at_us, own.actor, own.type, body);
    service_.save(std::move(batch), [this, entry, done = std::move(done)](bool saved) {
      service_.post([this, entry, done, saved] {
        if (saved) ++next_seq_;
        if (saved && is_logged(entry.actor, entry.what)) service_.views.write(entry);
        if (done) done(saved);
        turns_.end();
      });
    });
  });
}

void ServiceLog::carry_out(const std::string& id, Reply reply, const std::function<void(Reply)>& act) {
  if (seen_.count(id) > 0) return reply({});
  auto& waiting = open_[id];
  waiting.push_back(std::move(reply));
  if (waiting.size() > 1) return;
  try {
    act([this, id](const std::optional<Refusal>& refusal) {
      if (!refusal) seen_.insert(id);
      const auto senders = open_.extract(id);
      for (const auto& send : senders.mapped()) send(refusal);
    });
  } catch (...) {  // so that it can be sent again
    open_.erase(id);
    throw;
  }
}

}  // namespace kith
