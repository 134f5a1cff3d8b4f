// Rooms: loading, making, links, and the log of what was done outside of rooms.
#include <algorithm>
#include <charconv>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/store/json_members.hpp"
#include "kith/store/random_token.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::size_t kCodeLength = 6;
constexpr std::size_t kLogLength = 200;
constexpr std::size_t kMostAtOnce = 200;

LogEntry entry_of(const StoredEvent& event) {
  return log_entry(event.room, event.at_us, event.actor, event.type, Json::parse(event.json, nullptr, false));
}

// Why something happened that no facilitator gave a reason for.
std::string reason_for(const std::string& type, const Json& body) {
  if (type == "returned") return "followed the join link again: back in room " + text_at(body, "room");
  const auto by = count_at(body, "by");
  if ((type != happening::Dropped::kKind.word && type != happening::Left::kKind.word) || by == 0)
    return text_at(body, "reason");
  return "a simulated learner takes over as seat " + std::to_string(by);
}

// What a facilitator asks for when making rooms.
struct Wish {
  std::string strategy;
  std::vector<std::string> seats;
  std::size_t count = 1;
};

std::optional<Wish> wish_of(const Json& body) {
  Wish wish{.strategy = text_at(body, "strategy"), .seats = {}};
  if (const auto seats = body.find("seats"); seats != body.end()) {
    if (!seats->is_array() || seats->size() > 30) return std::nullopt;
    for (const auto& seat : *seats) {
      if (!seat.is_string()) return std::nullopt;
      wish.seats.push_back(seat.get<std::string>());
    }
  }
  if (const auto count = body.find("count"); count != body.end()) {
    if (!count->is_number_unsigned() || *count < 1 || *count > kMostAtOnce) return std::nullopt;
    wish.count = count->get<std::size_t>();
  }
  return wish;
}

// The cell of the design that has the fewest rooms, among those that fit the wish; if none has that many seats, among
// those of any size. Without a strategy if the study has none of this name.
LiveCell next_cell(const LiveStudy& study, const Wish& wish, const std::map<std::string, std::size_t>& rooms_of) {
  for (const bool is_any_size : {false, true}) {
    LiveCell best;
    std::size_t fewest = 0;
    for (const auto& cell : live_cells(study)) {
      if (!wish.strategy.empty() && cell.strategy != wish.strategy) continue;
      if (!wish.seats.empty()) {
        if (!is_any_size && cell.composition.size() != wish.seats.size()) continue;
        if (wish.seats.size() > 1 && strategy_of(study.spec, cell.strategy).is_baseline()) continue;
      }
      const auto found = rooms_of.find(cell.strategy + "/" + cell.composition);
      const auto count = found == rooms_of.end() ? 0 : found->second;
      if (best.strategy.empty() || count < fewest) {
        best = cell;
        fewest = count;
      }
    }
    if (!best.strategy.empty()) return best;
  }
  return {};
}

// The setup of one room; the people and stand-ins that the wish names are put into the composition of the cell.
RoomSetup setup_of(const LiveStudy& study, const Wish& wish, const std::map<std::string, std::size_t>& rooms_of) {
  const auto cell = next_cell(study, wish, rooms_of);
  RoomSetup setup;
  setup.strategy = cell.strategy.empty() ? wish.strategy : cell.strategy;
  setup.composition = cell.composition;
  if (!wish.seats.empty()) {
    setup.composition.resize(wish.seats.size(), study.spec.learner_types.front().letter);
    setup.simulated.resize(wish.seats.size());
    for (std::size_t i = 0; i < wish.seats.size(); ++i) {
      if (wish.seats[i] == "person") continue;
      setup.simulated[i] = true;
      setup.composition[i] = wish.seats[i].size() == 1 ? wish.seats[i].front() : '?';
    }
  }
  return setup;
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

std::string person_of(const LiveStudy& study, const Json& query) {
  const auto& collected = study.group().collect_query;
  const auto value =
      collected.empty() || !query.is_object() ? std::string{} : text_at(query, collected.front().c_str());
  return value.find("{{") == std::string::npos ? value : std::string{};  // what the platform did not fill in
}

void LiveService::State::note_person(std::int64_t room, const std::string& actor, const std::string& type,
                                     const Json& body) {
  const auto is = [&](const RoomEventKind& kind) { return type == kind.word; };
  const auto by_actor = static_cast<std::int64_t>(seat_of_actor(actor).value_or(0));
  if (is(happening::Consented::kKind)) {
    const auto person = person_of(*study, body.value("query", Json::object()));
    if (!person.empty()) seat_of_person[person] = {room, by_actor};
  }
  if (!is(happening::Declined::kKind) && !is(happening::Released::kKind)) return;
  const Place free{room, is(happening::Released::kKind) ? body.value("seat", std::int64_t{0}) : by_actor};
  std::erase_if(seat_of_person, [&](const auto& one) { return one.second == free; });
}

std::string room_id(std::int64_t number) { return "r" + std::to_string(number); }

std::int64_t room_number(const std::string& id) {
  std::int64_t number = 0;
  if (id.size() < 2 || id.front() != 'r') return 0;
  const auto* end = id.data() + id.size();
  const auto [rest, error] = std::from_chars(id.data() + 1, end, number);
  return error == std::errc{} && rest == end && number > 0 ? number : 0;
}

std::shared_ptr<HostedRoom> LiveService::State::room_of(std::int64_t number) const {
  const std::lock_guard lock{mutex};
  const auto found = rooms.find(number);
  return found == rooms.end() ? nullptr : found->second;
}

std::shared_ptr<HostedRoom> LiveService::State::room_named(const std::string& name) const {
  if (const auto room = room_of(room_number(name))) return room;
  const std::lock_guard lock{mutex};
  for (const auto& [number, room] : rooms) {
    if (room->setup().code == name) return room;
  }
  return nullptr;
}

void LiveService::State::load_rooms() {
  auto& file = store->file();
  tokens.emplace(file.tokens());
  std::map<std::int64_t, std::vector<StoredEvent>> events;
  std::vector<LogEntry> entries;
  std::vector<std::pair<Place, Place>> seated;  // from the waiting list, to a group
  const auto now = now_us();
  file.for_each_event([&](const StoredEvent& event) {
    if (is_logged(event.actor, event.type)) entries.push_back(entry_of(event));
    if (event.room == 0) next_service_seq = event.seq + 1;
    if (event.room == 0 && event.message) seen_messages.insert(*event.message);
    if (event.room != 0) note_person(event.room, event.actor, event.type, Json::parse(event.json));
    const bool is_seated = event.type == happening::Seated::kKind.word;
    if (event.room != 0 && (is_seated || event.type == happening::Joined::kKind.word)) {
      const auto body = Json::parse(event.json);
      const Place place{event.room, body.value("seat", std::int64_t{0})};
      joined.insert(place);
      contacts[place].last_seen_us = now;
      if (is_seated) seated.emplace_back(origin_of(body), place);
    }
    events[event.room].push_back(event);
  });
  for (const auto& [from, to] : seated) move_person(from, to);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const LogEntry& a, const LogEntry& b) { return a.at_us < b.at_us; });
  for (auto& entry : entries) write_log(std::move(entry));
  for (auto& stored : file.rooms()) {
    auto setup = room_setup(Json::parse(stored.setup));
    const auto number = stored.number;
    next_room = std::max(next_room, number + 1);
    ++rooms_of[setup.strategy + "/" + setup.composition];
    if (setup.is_waiting_list) waiting_list = number;
    rooms.emplace(number, std::make_shared<HostedRoom>(*this, study, std::move(stored), std::move(setup)));
    changed_rooms.insert(number);
  }
  for (const auto& [number, room] : rooms) room->rebuild(std::move(events[number]));
}

std::size_t LiveService::State::num_groups() const { return rooms.size() - (waiting_list != 0 ? 1u : 0u); }

void LiveService::State::enrol(RoomSetup& setup) {
  setup.id = room_id(next_room++);
  setup.replicate = ++rooms_of[setup.strategy + "/" + setup.composition];
}

void LiveService::State::write_log(LogEntry entry) {
  log.push_back(std::move(entry));
  if (log.size() > kLogLength) log.pop_front();
  has_news = true;
}

void LiveService::State::record(StoreBatch batch, const std::string& actor, const std::string& type, const Json& body,
                                const std::string& message, std::function<void(bool saved)> done) {
  StoredEvent event{.actor = actor, .type = type, .json = body.dump()};
  if (!message.empty()) event.message = message;
  batch.events.insert(batch.events.begin(), std::move(event));
  post(0, [this, batch = std::move(batch), done = std::move(done)](TeachingCache&) mutable {
    recordings.push_back({std::move(batch), std::move(done)});
    record_next();
  });
}

void LiveService::State::record_next() {
  if (is_recording || recordings.empty()) return;
  is_recording = true;
  auto recording = std::move(recordings.front());
  recordings.pop_front();
  auto& event = recording.batch.events.front();
  event.seq = next_service_seq;
  event.at_us = now_us();
  const auto entry = entry_of(event);
  save(std::move(recording.batch), [this, entry, done = std::move(recording.done)](bool saved) {
    post(0, [this, entry, done, saved](TeachingCache&) {
      is_recording = false;
      if (saved) {
        ++next_service_seq;
        const std::lock_guard lock{mutex};
        if (is_logged(entry.actor, entry.what)) write_log(entry);
      }
      done(saved);
      record_next();
    });
  });
}

void LiveService::State::make_rooms(const Json& body, const std::string& actor, const std::string& message,
                                    std::function<void(const RoomsMade&)> made) {
  const auto refuse = [&](const char* reason, const std::string& text) {
    made({.rooms = {}, .refusal = Refusal{reason, text}});
  };
  const auto wish = wish_of(body);
  if (!wish) return refuse("bad-body", "A room needs a strategy, up to 30 seats and a count from 1 to 200.");
  {
    const std::lock_guard lock{mutex};
    if (num_groups() + wish->count > options.max_rooms)
      return refuse("full", "This server is limited to " + std::to_string(options.max_rooms) + " rooms.");
    if (free_space < kNoSpace) return refuse("no-space", "The disk is almost full: no new rooms can be made.");
  }
  StoreBatch batch;
  RoomsMade result;
  std::vector<std::shared_ptr<HostedRoom>> hosted;
  std::vector<Tokens::Issued> links;
  TeachingCache cache{study->atlas};
  for (std::size_t i = 0; i < wish->count; ++i) {
    RoomSetup setup;
    {
      const std::lock_guard lock{mutex};
      setup = setup_of(*study, *wish, rooms_of);
      enrol(setup);
    }
    const auto number = room_number(setup.id);
    setup.code = random_code(kCodeLength);
    setup.salt = random_token();
    std::size_t seats = 0;
    try {
      const Room room{study, setup, cache};
      seats = room.num_seats();
      const std::lock_guard lock{mutex};
      for (std::size_t seat = 1; seat <= seats; ++seat) {
        if (!room.is_person(seat)) continue;
        links.push_back(tokens->issue(Role::kParticipant, number, static_cast<std::int64_t>(seat),
                                      now_us() + options.token_hours * 3600 * kSecond));
        batch.tokens.push_back(links.back().row);
      }
    } catch (const Error& error) {
      return refuse("bad-room", error.what());
    }
    StoredRoom stored{.number = number, .setup = to_json(setup).dump(), .created_us = now_us()};
    batch.rooms.push_back(stored);
    result.rooms.push_back(number);
    hosted.push_back(std::make_shared<HostedRoom>(*this, study, std::move(stored), std::move(setup)));
  }
  Json what = body;
  what["rooms"] = Json::array();
  for (const auto number : result.rooms) what["rooms"].push_back(room_id(number));
  record(std::move(batch), actor, "room-make", what, message, [this, result, hosted, made](bool saved) {
    if (!saved) return made({.rooms = {}, .refusal = Refusal{"not-saved", "This could not be saved; try again."}});
    {
      const std::lock_guard lock{mutex};
      for (const auto& room : hosted) {
        rooms.emplace(room->number(), room);
        changed_rooms.insert(room->number());
      }
    }
    for (const auto& room : hosted) {
      post(room->number(), [room](TeachingCache& own) { room->begin(own); });
    }
    made(result);
  });
}

void LiveService::State::make_link(std::int64_t room, std::int64_t seat, std::function<void(std::string token)> made) {
  Tokens::Issued issued;
  {
    const std::lock_guard lock{mutex};
    issued = tokens->issue(Role::kParticipant, room, seat, now_us() + options.token_hours * 3600 * kSecond);
  }
  StoreBatch batch;
  batch.tokens.push_back(issued.row);
  save(std::move(batch), [this, issued, room, made = std::move(made)](bool saved) {
    const std::lock_guard lock{mutex};
    if (!saved) tokens->revoke(issued.row.hash);
    changed_rooms.insert(room);
    made(saved ? issued.token : std::string{});
  });
}

LiveService::StartLinks LiveService::start_links() {
  auto& state = *state_;
  StartLinks links;
  StoreBatch batch;
  {
    const std::lock_guard lock{state.mutex};
    const auto expires = state.now_us() + state.options.token_hours * 3600 * kSecond;
    auto facilitator = state.tokens->issue(Role::kFacilitator, 0, 0, expires);
    auto observer = state.tokens->issue(Role::kObserver, 0, 0, expires);
    links = {.facilitator = facilitator.token, .observer = observer.token};
    state.facilitator_token = links.facilitator;
    state.observer_token = links.observer;
    batch.tokens = {facilitator.row, observer.row};
  }
  state.save(std::move(batch), [](bool) {});
  return links;
}

}  // namespace kith
