#include "kith/service/authorisation.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "kith/live/room_event.hpp"

namespace kith {
namespace {

constexpr bool kYes = true;
constexpr bool kNo = false;

// name, nobody, participant, observer, facilitator
constexpr std::array kOthers{
    Permission{"hello", kYes, kYes, kYes, kYes},
    Permission{"beat", kNo, kYes, kYes, kYes},
    Permission{"room-make", kNo, kNo, kNo, kYes},
    Permission{"room-select", kNo, kNo, kYes, kYes},
    Permission{"link-revoke", kNo, kNo, kNo, kYes},
    // Requests.
    Permission{"GET /api/health", kYes, kYes, kYes, kYes},
    Permission{"POST /api/join", kYes, kYes, kYes, kYes},
    Permission{"GET /api/texts", kYes, kYes, kYes, kYes},
    Permission{"GET /api/world", kNo, kYes, kYes, kYes},
    Permission{"GET /api/export", kNo, kNo, kNo, kYes},
    Permission{"GET /api/qr", kNo, kNo, kNo, kYes},
    Permission{"GET /api/integrity", kNo, kNo, kNo, kYes},
};

struct RoleName {
  Role role;
  std::string_view name;
};
constexpr std::array kRoles{RoleName{Role::kNobody, "nobody"}, RoleName{Role::kParticipant, "participant"},
                            RoleName{Role::kObserver, "observer"}, RoleName{Role::kFacilitator, "facilitator"}};

}  // namespace

std::string_view name_of(Role role) noexcept {
  return std::find_if(kRoles.begin(), kRoles.end(), [&](const RoleName& one) { return one.role == role; })->name;
}

Role role_named(std::string_view name) noexcept {
  const auto* const found =
      std::find_if(kRoles.begin(), kRoles.end(), [&](const RoleName& one) { return one.name == name; });
  return found == kRoles.end() ? Role::kNobody : found->role;
}

std::span<const Permission> permissions() noexcept {
  static const std::vector<Permission> kAll = [] {
    std::vector<Permission> all{kOthers.begin(), kOthers.end()};
    // What leads to the events of rooms: people in their own seat, which is that of their token, and facilitators.
    for (const auto& kind : kRoomEventKinds) {
      const bool is_there =
          std::any_of(all.begin(), all.end(), [&](const Permission& one) { return one.name == kind.command; });
      if (kind.command.empty() || kind.sender == RoomSender::kServer || is_there) continue;
      const bool is_seat = kind.sender == RoomSender::kSeat;
      all.push_back({kind.command, kNo, is_seat, kNo, !is_seat});
    }
    return all;
  }();
  return kAll;
}

bool is_allowed(std::string_view name, Role role) noexcept {
  for (const auto& permission : permissions()) {
    if (permission.name != name) continue;
    switch (role) {
      case Role::kNobody:
        return permission.nobody;
      case Role::kParticipant:
        return permission.participant;
      case Role::kObserver:
        return permission.observer;
      case Role::kFacilitator:
        return permission.facilitator;
    }
  }
  return false;
}

}  // namespace kith
