#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace kith {

/// Who asks. Whoever has no valid token is nobody.
enum class Role : std::uint8_t { kNobody, kParticipant, kObserver, kFacilitator };

/// "nobody", "participant", "observer", "facilitator".
[[nodiscard]] std::string_view name_of(Role role) noexcept;
/// The role of that name; kNobody for any other name.
[[nodiscard]] Role role_named(std::string_view name) noexcept;

/// One thing that can be asked for, and who may ask for it.
struct Permission {
  std::string_view name;  ///< "answer" for a message, "GET /api/export" for a route.
  bool nobody = false;
  bool participant = false;
  bool observer = false;
  bool facilitator = false;
};

/// Every message and route that there is. What is not in this table is allowed to nobody.
[[nodiscard]] std::span<const Permission> permissions() noexcept;

/// Whether the role may ask for it; false for names that are not in the table.
[[nodiscard]] bool is_allowed(std::string_view name, Role role) noexcept;

}  // namespace kith
