#include "kith/service/live_service.hpp"

#include <algorithm>
#include <chrono>
#include <future>
#include <limits>
#include <system_error>
#include <utility>

#include "json_depth.hpp"
#include "kith/core/error.hpp"
#include "kith/files/sha256.hpp"
#include "kith/store/json_members.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::size_t kStrandThreads = 4;  // one of them may be exporting, one making rooms
constexpr std::size_t kStrandCacheBytes = std::size_t{8} << 20;
constexpr auto kTick = std::chrono::milliseconds{100};
constexpr std::size_t kJoinCodeLength = 8;

std::int64_t system_now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::uint64_t system_free_bytes(const std::filesystem::path& folder) {
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  return error ? std::numeric_limits<std::uint64_t>::max() : space.available;
}

// The code under which people join the study, the same whenever this store is served.
std::string code_of(const std::string& store) {
  constexpr std::string_view kAlphabet = "23456789ABCDEFGHJKLMNPQRSTUVWXYZ";
  Sha256 hash;
  hash.update("join " + store);
  std::string code;
  for (const char c : std::move(hash).digest().substr(0, kJoinCodeLength))
    code += kAlphabet[static_cast<unsigned char>(c) & 31u];
  return code;
}

LiveServiceOptions filled(LiveServiceOptions options, const LiveStudy& study) {
  if (!options.now_us) options.now_us = system_now_us;
  if (!options.free_bytes) options.free_bytes = system_free_bytes;
  if (options.digest.empty()) options.digest = sha256(live_study_json(study).dump());
  return options;
}

// The frame as an object, or nothing. Nesting is limited, since what is nested deeply costs more than it is long.
std::optional<Json> parse_frame(std::string_view text) {
  constexpr std::size_t kDeepest = 32;
  if (!json_nests_within(text, kDeepest)) return std::nullopt;
  auto json = Json::parse(text, nullptr, false);
  return json.is_object() ? std::optional{std::move(json)} : std::nullopt;
}

}  // namespace

ServiceState::ServiceState(std::shared_ptr<const LiveStudy> live_study, LiveServiceOptions service_options)
    : study{std::move(live_study)},
      options{filled(std::move(service_options), *study)},
      store{options.folder,
            StoreIdentity{.study = options.digest, .program = options.program, .inputs = options.inputs},
            options.now_us},
      join_code{code_of(store.file().id())},
      free_space{options.free_bytes(options.folder)},
      caches{study->atlas, kStrandCacheBytes},
      teachers{study->atlas, options.teaching_workers, options.cache_bytes, busy},
      strands{kStrandThreads, busy} {
  try {
    load();
  } catch (...) {  // before anything goes that jobs still use
    stop();
    throw;
  }
}

std::int64_t ServiceState::links_expire_us() const { return now_us() + options.token_hours * 3600 * kSecond; }

void ServiceState::save(StoreBatch batch, std::function<void(bool)> done) {
  store.write(std::move(batch), busy.during(std::move(done)));
}

// Before there is anybody: what is loaded needs no strand. Rooms are rebuilt last, by others.
void ServiceState::load() {
  auto& file = store.file();
  for (const auto& link : file.tokens()) directory.add(link);
  std::map<std::int64_t, std::shared_ptr<HostedRoom>> hosted;
  for (auto& stored : file.rooms()) {
    auto setup = room_setup(Json::parse(stored.setup));
    maker.numbers().count(stored.number, setup);
    const auto room = std::make_shared<HostedRoom>(*this, std::move(stored), std::move(setup));
    hosted.emplace(room->number(), room);
    directory.add(room);
  }

  std::map<std::int64_t, std::vector<StoredEvent>> events;
  std::vector<LogEntry> entries;
  std::vector<std::pair<Place, Place>> seated;  // from the waiting list, to a group
  file.for_each_event([&](const StoredEvent& event) {
    const auto body = Json::parse(event.json, nullptr, false);
    if (is_logged(event.actor, event.type))
      entries.push_back(log_entry(event.room, event.at_us, event.actor, event.type, body));
    if (event.room == 0) return log.load(event);
    directory.note(event.room, event.actor, event.type, body);
    const auto seat = count_at(body, "seat");
    const bool is_seated = event.type == happening::Seated::kKind.word;
    if (is_seated) seated.emplace_back(origin_of(body), Place{event.room, static_cast<std::int64_t>(seat)});
    if (is_seated || event.type == happening::Joined::kKind.word) hosted.at(event.room)->pages().take(seat);
    events[event.room].push_back(event);
  });
  for (const auto& [from, to] : seated) {
    directory.joined(to);
    directory.move(from, to);
    if (const auto list = hosted.find(from.first); list != hosted.end()) {
      list->second->pages().move(static_cast<std::size_t>(from.second), hosted.at(to.first)->pages(),
                                 static_cast<std::size_t>(to.second));
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const LogEntry& a, const LogEntry& b) { return a.at_us < b.at_us; });
  for (auto& entry : entries) views.write(std::move(entry));
  waiting.make();
  for (const auto& [number, room] : hosted) room->rebuild(std::move(events[number]));
}

void ServiceState::on_applied(HostedRoom& room, std::span<const RoomEvent> events) {
  for (const auto& event : events) {
    const std::string type{event.kind().word};
    const bool is_told = is_logged(event.actor, type), is_noted = Directory::notes(type);
    if (!is_told && !is_noted) continue;
    const auto body = body_of(event);
    if (const auto* joined = event.get<happening::Joined>()) room.pages().take(joined->seat);
    if (is_told) views.write(log_entry(room.number(), event.at_us, event.actor, type, body));
    if (!is_noted) continue;
    post(
        [this, number = room.number(), actor = event.actor, type, body] { directory.note(number, actor, type, body); });
  }
  views.changed(room.shared_from_this());
  room.pages().show(room);
}

void ServiceState::check_space(std::int64_t now) {
  if (now - looked_at_space_us < kSecond) return;
  looked_at_space_us = now;
  const auto level = [](std::uint64_t bytes) { return bytes < kNoSpace ? 2 : bytes < kLittleSpace ? 1 : 0; };
  const auto free = options.free_bytes(options.folder);
  if (level(free) != level(free_space.exchange(free))) views.news();
}

void ServiceState::tick() {
  if (is_stopping) return;
  post([this] {
    check_space(now_us());
    directory.tick();
    views.tick();
  });
}

void ServiceState::keep_ticking() {
  timer.expires_after(kTick);
  timer.async_wait([this](NetError error) {
    if (error || is_stopping) return;
    tick();
    keep_ticking();
  });
}

void ServiceState::stop() {
  if (is_stopping.exchange(true)) return;
  post([this] { directory.say_goodbye(); });
  teachers.stop();
  busy.wait_for_none();
  post([this] {
    for (const auto& [number, room] : directory.rooms()) room->post([room = room] { room->abandon(); });
  });
  busy.wait_for_none();
  strands.stop();
}

LiveService::LiveService(std::shared_ptr<const LiveStudy> study, LiveServiceOptions options)
    : state_{std::make_unique<ServiceState>(std::move(study), std::move(options))} {
  if (state_->options.ticks) state_->keep_ticking();
}

LiveService::~LiveService() { stop(); }

LiveService::StartLinks LiveService::start_links() {
  const auto expires = state_->links_expire_us();
  const auto facilitator = Tokens::issue(Role::kFacilitator, 0, 0, expires);
  const auto observer = Tokens::issue(Role::kObserver, 0, 0, expires);
  state_->post([&state = *state_, facilitator, observer] {
    state.directory.add(facilitator);
    state.directory.add(observer);
    state.directory.set_links(facilitator.token, observer.token);
  });
  state_->save({.tokens = {facilitator.row, observer.row}}, [](bool) {});
  return {.facilitator = facilitator.token, .observer = observer.token, .code = state_->join_code};
}

std::vector<std::string> LiveService::make_rooms(std::size_t count, const std::vector<std::string>& seats) {
  std::vector<std::string> tokens;
  while (count > 0) {
    if (state_->is_stopping) throw Error{ErrorKind::kIo, "The server is stopping."};
    const auto now = std::min(count, RoomMaker::kMostAtOnce);
    Json body{{"count", now}, {"reason", "kith serve"}};
    if (!seats.empty()) body["seats"] = seats;
    const auto promise = std::make_shared<std::promise<RoomMaker::Made>>();
    state_->post([&maker = state_->maker, body, promise] {
      maker.make(body, "facilitator", {}, [promise](const RoomMaker::Made& made) { promise->set_value(made); });
    });
    const auto made = promise->get_future().get();
    if (made.refusal) throw Error{ErrorKind::kInfeasible, made.refusal->text};
    tokens.insert(tokens.end(), made.tokens.begin(), made.tokens.end());
    count -= now;
  }
  return tokens;
}

std::size_t LiveService::num_rooms() const { return state_->directory.num_groups(); }

std::size_t LiveService::num_sessions() const { return state_->num_sessions; }

void LiveService::set_base_url(std::string url) {
  if (state_->is_stopping) return;
  state_->post([&state = *state_, url = std::move(url)] { state.directory.set_base_url(url); });
}

LiveService::ConnectionId LiveService::open(std::shared_ptr<Socket> socket, std::string /*remote*/) {
  const auto connection = std::make_shared<Connection>(++state_->last_connection, std::move(socket));
  if (!state_->is_stopping) state_->post([&state = *state_, connection] { state.directory.open(connection); });
  return connection->id;
}

void LiveService::receive(ConnectionId id, std::string_view text) {
  if (state_->is_stopping) return;
  state_->post([&state = *state_, id, frame = parse_frame(text)] { state.directory.receive(id, frame); });
}

void LiveService::measured(ConnectionId id, std::chrono::microseconds round_trip) {
  if (state_->is_stopping) return;
  state_->post([&state = *state_, id, round_trip] { state.directory.measured(id, round_trip); });
}

void LiveService::closed(ConnectionId id) {
  if (state_->is_stopping) return;
  state_->post([&state = *state_, id] { state.directory.closed(id); });
}

void LiveService::http(HttpRequest request, HttpAnswer answer) { state_->handle(request, answer); }

void LiveService::tick() { state_->tick(); }

void LiveService::settle() { state_->busy.wait_for_none(); }

void LiveService::stop() { state_->stop(); }

}  // namespace kith
