#include "kith/service/live_service.hpp"

#include <chrono>
#include <limits>
#include <numeric>
#include <system_error>
#include <utility>

#include "kith/files/sha256.hpp"
#include "kith/store/random_token.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::size_t kStrandThreads = 2;
constexpr std::size_t kStrandCacheBytes = std::size_t{8} << 20;
constexpr auto kTick = std::chrono::milliseconds{100};
constexpr std::size_t kRoomsPerTick = 50;  // that facilitators are shown
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

}  // namespace

LiveService::State::State(std::shared_ptr<const LiveStudy> live_study, LiveServiceOptions service_options)
    : study{std::move(live_study)}, options{std::move(service_options)}, clock{options.now_us} {
  if (!clock) clock = system_now_us;
  if (!options.free_bytes) options.free_bytes = system_free_bytes;
  if (options.digest.empty()) options.digest = sha256(live_study_json(*study).dump());
  store = std::make_unique<EventStore>(
      options.folder, StoreIdentity{.study = options.digest, .program = options.program, .inputs = options.inputs},
      clock);
  join_code = code_of(store->file().id());
  free_space = options.free_bytes(options.folder);
  teachers = std::make_unique<TeachingPool>(study->atlas, options.teaching_workers, options.cache_bytes, busy);
  strands = std::make_unique<Strands>(study->atlas, kStrandThreads, kStrandCacheBytes, busy);
  load_rooms();
  make_waiting_list();
}

void LiveService::State::post(std::int64_t room, Strands::Job job) {
  strands->post(static_cast<std::size_t>(room), std::move(job));
}

void LiveService::State::save(StoreBatch batch, std::function<void(bool)> done) {
  busy.begin();
  store->write(std::move(batch), [this, done = std::move(done)](bool saved) {
    done(saved);
    busy.end();
  });
}

void LiveService::State::teach(TeachingPool::Urgency urgency, TeachingPool::Job job) {
  teachers->post(urgency, std::move(job));
}

std::size_t LiveService::State::num_runners_up(std::int64_t room) const {
  constexpr std::size_t kRunnersUp = 4;
  const std::lock_guard lock{mutex};
  return selected.count(room) != 0 ? kRunnersUp : 0;
}

void LiveService::State::on_applied(HostedRoom& room, std::span<const RoomEvent> events) {
  {
    const std::lock_guard lock{mutex};
    for (const auto& event : events) {
      if (const auto* came = event.get<happening::Joined>()) {
        const auto seat = static_cast<std::int64_t>(came->seat);
        joined.insert({room.number(), seat});
        auto& contact = contacts[{room.number(), seat}];
        if (contact.last_seen_us == 0) contact.last_seen_us = now_us();
      }
      if (event.get<happening::Consented>() != nullptr || event.get<happening::Declined>() != nullptr)
        queries.erase({room.number(), static_cast<std::int64_t>(seat_of_actor(event.actor).value_or(0))});
      const std::string type{event.kind().word};
      note_person(room.number(), event.actor, type, body_of(event));
      if (is_logged(event.actor, type)) {
        write_log(log_entry(room.number(), event.at_us, event.actor, type, body_of(event)));
      }
    }
    changed_rooms.insert(room.number());
  }
  push_room(room);
}

void LiveService::State::on_trouble(std::int64_t room, const std::string& what) {
  const std::lock_guard lock{mutex};
  troubles[room] = what;
  has_news = true;
}

void LiveService::State::check_space(std::int64_t now) {
  {
    const std::lock_guard lock{mutex};
    if (now - looked_at_space_us < kSecond) return;
    looked_at_space_us = now;
  }
  const auto free = options.free_bytes(options.folder);
  const std::lock_guard lock{mutex};
  const auto level = [](std::uint64_t bytes) { return bytes < kNoSpace ? 2 : bytes < kLittleSpace ? 1 : 0; };
  has_news = has_news || level(free) != level(free_space);
  free_space = free;
}

void LiveService::State::tick() {
  const auto now = now_us();
  check_space(now);
  check_presence(now);
  std::vector<std::shared_ptr<HostedRoom>> due;
  std::vector<std::shared_ptr<HostedRoom>> changed;
  bool is_new = false;
  {
    const std::lock_guard lock{mutex};
    for (const auto& [number, room] : rooms) {
      if (room->next_due_us() <= now || room->is_unsaved()) due.push_back(room);
    }
    if (num_facilitators > 0) {
      for (const auto number : std::exchange(changed_rooms, {})) {
        const auto found = rooms.find(number);
        if (found != rooms.end()) changed.push_back(found->second);
      }
      // The page of many rooms is large, and something happens in one of them all the time.
      const bool is_awaited = ticks_awaited > 0;
      if (is_awaited) --ticks_awaited;
      if (++ticks_since_shown > pictures.size() / kRoomsPerTick || is_awaited) {
        is_new = std::exchange(has_news, false);
        if (is_new) ticks_since_shown = 0;
      }
    }
  }
  for (const auto& room : due) post(room->number(), [room](TeachingCache&) { room->wake(); });
  for (const auto& room : changed) post(room->number(), [this, room](TeachingCache&) { take_picture(*room); });
  if (is_new) post(0, [this](TeachingCache&) { show_facilitators(); });
}

LiveService::LiveService(std::shared_ptr<const LiveStudy> study, LiveServiceOptions options)
    : state_{std::make_unique<State>(std::move(study), std::move(options))} {
  if (!state_->options.ticks) return;
  state_->ticker = std::thread{[&state = *state_] {
    std::unique_lock lock{state.ticking};
    while (true) {
      const bool stops = state.ticks.wait_for(lock, kTick, [&] {
        const std::lock_guard guard{state.mutex};
        return state.is_stopping;
      });
      if (stops) return;
      state.tick();
    }
  }};
}

LiveService::~LiveService() { stop(); }

std::size_t LiveService::num_rooms() const {
  const std::lock_guard lock{state_->mutex};
  return state_->num_groups();
}

std::size_t LiveService::num_sessions() const {
  const std::lock_guard lock{state_->mutex};
  return std::accumulate(state_->rooms.begin(), state_->rooms.end(), std::size_t{0},
                         [](std::size_t sum, const auto& entry) { return sum + entry.second->num_sessions(); });
}

void LiveService::set_base_url(std::string url) {
  const std::lock_guard lock{state_->mutex};
  state_->base_url = std::move(url);
  state_->has_news = true;
}

void LiveService::tick() { state_->tick(); }

void LiveService::settle() { state_->busy.wait_for_none(); }

}  // namespace kith
