#include "kith/hosting/authorisation.hpp"

#include <array>

namespace kith {
namespace {

constexpr bool kYes = true;
constexpr bool kNo = false;

// name, nobody, participant, observer, facilitator
constexpr std::array kPermissions{
    Permission{"hello", kYes, kYes, kYes, kYes},
    Permission{"beat", kNo, kYes, kYes, kYes},
    // What people do in their own seat; the seat is that of their token.
    Permission{"consent", kNo, kYes, kNo, kNo},
    Permission{"checked", kNo, kYes, kNo, kNo},
    Permission{"name", kNo, kYes, kNo, kNo},
    Permission{"screen", kNo, kYes, kNo, kNo},
    Permission{"watched", kNo, kYes, kNo, kNo},
    Permission{"draft", kNo, kYes, kNo, kNo},
    Permission{"answer", kNo, kYes, kNo, kNo},
    Permission{"continue", kNo, kYes, kNo, kNo},
    Permission{"questions", kNo, kYes, kNo, kNo},
    Permission{"leave", kNo, kYes, kNo, kNo},
    // What facilitators do to rooms.
    Permission{"start", kNo, kNo, kNo, kYes},
    Permission{"pause", kNo, kNo, kNo, kYes},
    Permission{"resume", kNo, kNo, kNo, kYes},
    Permission{"extend", kNo, kNo, kNo, kYes},
    Permission{"message", kNo, kNo, kNo, kYes},
    Permission{"readmit", kNo, kNo, kNo, kYes},
    Permission{"simulate", kNo, kNo, kNo, kYes},
    Permission{"strategy", kNo, kNo, kNo, kYes},
    Permission{"end", kNo, kNo, kNo, kYes},
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

constexpr std::array<std::string_view, 4> kRoles{"nobody", "participant", "observer", "facilitator"};

}  // namespace

std::string_view name_of(Role role) noexcept { return kRoles[static_cast<std::size_t>(role)]; }

Role role_named(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kRoles.size(); ++i) {
    if (kRoles[i] == name) return static_cast<Role>(i);
  }
  return Role::kNobody;
}

std::span<const Permission> permissions() noexcept { return kPermissions; }

bool is_allowed(std::string_view name, Role role) noexcept {
  for (const auto& permission : kPermissions) {
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
