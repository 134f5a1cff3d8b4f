#include "room_maker.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "kith/store/json_members.hpp"
#include "kith/store/random_token.hpp"
#include "service_state.hpp"

namespace kith {
namespace {

constexpr std::size_t kCodeLength = 6;

std::optional<RoomWish> wish_of(const Json& body) {
  RoomWish wish{.strategy = text_at(body, "strategy")};
  if (const auto seats = body.find("seats"); seats != body.end()) {
    if (!seats->is_array() || seats->size() > 30) return std::nullopt;
    for (const auto& seat : *seats) {
      if (!seat.is_string()) return std::nullopt;
      wish.seats.push_back(seat.get<std::string>());
    }
  }
  if (const auto count = body.find("count"); count != body.end()) {
    if (!count->is_number_unsigned() || *count < 1 || *count > RoomMaker::kMostAtOnce) return std::nullopt;
    wish.count = count->get<std::size_t>();
  }
  return wish;
}

std::string cell_key(const std::string& strategy, const std::string& composition) {
  return strategy + "/" + composition;
}

// The cell of the design that has the fewest rooms, among those that fit the wish; if none has that many seats, among
// those of any size. Without a strategy if the study has none of this name.
LiveCell next_cell(const LiveStudy& study, const RoomWish& wish, const std::map<std::string, std::size_t>& made) {
  for (const bool is_any_size : {false, true}) {
    LiveCell best;
    std::size_t fewest = 0;
    for (const auto& cell : live_cells(study)) {
      if (!wish.strategy.empty() && cell.strategy != wish.strategy) continue;
      if (!wish.seats.empty()) {
        if (!is_any_size && cell.composition.size() != wish.seats.size()) continue;
        if (wish.seats.size() > 1 && strategy_of(study.spec, cell.strategy).is_baseline()) continue;
      }
      const auto found = made.find(cell_key(cell.strategy, cell.composition));
      const auto count = found == made.end() ? 0 : found->second;
      if (best.strategy.empty() || count < fewest) {
        best = cell;
        fewest = count;
      }
    }
    if (!best.strategy.empty()) return best;
  }
  return {};
}

}  // namespace

std::string room_id(std::int64_t number) { return "r" + std::to_string(number); }

std::int64_t room_number(const std::string& id) {
  std::int64_t number = 0;
  if (id.size() < 2 || id.front() != 'r') return 0;
  const auto* end = id.data() + id.size();
  const auto [rest, error] = std::from_chars(id.data() + 1, end, number);
  return error == std::errc{} && rest == end && number > 0 ? number : 0;
}

void RoomNumbers::count(std::int64_t number, const RoomSetup& setup) {
  const std::lock_guard lock{mutex_};
  next_ = std::max(next_, number + 1);
  ++made_[cell_key(setup.strategy, setup.composition)];
}

RoomSetup RoomNumbers::enrolled(RoomSetup setup) {
  setup.id = room_id(next_++);
  setup.replicate = ++made_[cell_key(setup.strategy, setup.composition)];
  setup.code = random_code(kCodeLength);
  setup.salt = random_token();
  return setup;
}

RoomSetup RoomNumbers::setup_for(const std::string& strategy, const std::string& composition,
                                 std::vector<bool> simulated) {
  RoomSetup setup;
  setup.strategy = strategy;
  setup.composition = composition;
  setup.simulated = std::move(simulated);
  const std::lock_guard lock{mutex_};
  return enrolled(std::move(setup));
}

// The people and stand-ins that the wish names are put into the composition of the cell.
RoomSetup RoomNumbers::setup_for(const LiveStudy& study, const RoomWish& wish) {
  const std::lock_guard lock{mutex_};
  const auto cell = next_cell(study, wish, made_);
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
  return enrolled(std::move(setup));
}

// Rooms that are made together.
struct RoomMaker::Batch {
  RoomWish wish;
  Json body;
  std::string actor, message;
  Done done;
  StoreBatch stored{};
  std::vector<Tokens::Issued> links{};
  Made made{};
};

RoomMaker::RoomMaker(ServiceState& service) : service_{service}, strand_{service.strands.make()} {}

void RoomMaker::make(const Json& body, const std::string& actor, const std::string& message, Done done) {
  const auto refuse = [&](const char* reason, const std::string& text) { done({.refusal = Refusal{reason, text}}); };
  auto wish = wish_of(body);
  if (!wish) return refuse("bad-body", "A room needs a strategy, up to 30 seats and a count from 1 to 200.");
  const auto most = service_.options.max_rooms;
  if (service_.directory.num_groups() + wish->count > most)
    return refuse("full", "This server is limited to " + std::to_string(most) + " rooms.");
  if (service_.free_space < kNoSpace) return refuse("no-space", "The disk is almost full: no new rooms can be made.");

  const auto batch = std::make_shared<Batch>(
      Batch{.wish = *std::move(wish), .body = body, .actor = actor, .message = message, .done = std::move(done)});
  service_.strands.post(strand_, [this, batch] {
    try {
      build(*batch);
    } catch (const std::exception& error) {
      batch->made = {.refusal = Refusal{"bad-room", error.what()}};
    }
    service_.post([this, batch] { save(batch); });
  });
}

void RoomMaker::build(Batch& batch) {
  const auto& study = service_.study;
  const auto expires = service_.links_expire_us();
  batch.body["rooms"] = Json::array();
  for (std::size_t i = 0; i < batch.wish.count; ++i) {
    auto setup = numbers_.setup_for(*study, batch.wish);
    const auto number = room_number(setup.id);
    service_.caches.lend([&](TeachingCache& cache) {
      const Room room{study, setup, cache};
      for (std::size_t seat = 1; seat <= room.num_seats(); ++seat) {
        if (!room.is_person(seat)) continue;
        batch.links.push_back(Tokens::issue(Role::kParticipant, number, static_cast<std::int64_t>(seat), expires));
        batch.stored.tokens.push_back(batch.links.back().row);
      }
    });

    StoredRoom stored{.number = number, .setup = to_json(setup).dump(), .created_us = service_.now_us()};
    batch.stored.rooms.push_back(stored);
    batch.body["rooms"].push_back(setup.id);
    batch.made.rooms.push_back(std::make_shared<HostedRoom>(service_, std::move(stored), std::move(setup)));
  }
}

void RoomMaker::save(const std::shared_ptr<Batch>& batch) {
  if (batch->made.refusal) return batch->done(batch->made);
  service_.log.record(std::move(batch->stored), batch->actor, "room-make", batch->body, batch->message,
                      [this, batch](bool saved) {
                        if (!saved) return batch->done({.refusal = not_saved()});
                        for (const auto& link : batch->links) {
                          service_.directory.add(link);
                          batch->made.tokens.push_back(link.token);
                        }
                        for (const auto& room : batch->made.rooms) {
                          service_.directory.add(room);
                          room->post([room] { room->begin(); });
                        }
                        batch->done(batch->made);
                      });
}

}  // namespace kith
