#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "kith/explain/json.hpp"

namespace kith {

/// What a command may say of a member of its event, and what is answered to anything else.
struct Limits {
  std::int64_t least = 0;
  std::int64_t most = std::numeric_limits<std::int64_t>::max();   ///< Of a number, or of each in a list.
  std::size_t shortest = 0;                                       ///< Bytes of a text, or of each in a list.
  std::size_t longest = std::numeric_limits<std::size_t>::max();  ///< Bytes of a text, or of each in a list.
  bool is_one_line = false;                                       ///< Of a text.
  bool may_miss = false;                                          ///< Then it is that of a new event.
  bool is_stored = true;                                          ///< Otherwise it is part of the command only.
  bool (*fits)(const Json&) = nullptr;                            ///< Of JSON; null: anything does.
  std::string_view reason = "bad-body";                           ///< Of the refusal.
  std::string_view text{};                                        ///< Empty: that of whoever reads the command.
  std::string_view type{};                                        ///< Of JSON, in TypeScript.
};

/// A member of an event or of a view by its name in JSON; with '?' one that is left out unless it is set.
template <typename Owner, typename T>
struct Member {
  constexpr Member(std::string_view name_in_json, T Owner::*member)
      : name{name_in_json.substr(0, name_in_json.find('?'))}, may_miss{name != name_in_json}, at{member} {}
  constexpr Member(std::string_view name_in_json, T Owner::*member, const Limits& limits)
      : Member{name_in_json, member} {
    asked = limits;
  }

  std::string_view name;
  bool may_miss;
  T Owner::*at;
  std::optional<Limits> asked{};  ///< What commands may say of it; nothing: it is not asked for.
};

/// Calls visit(member, value) for every member of an event or view.
template <typename Owner, typename Visit>
constexpr void for_each_member(Owner& owner, Visit visit) {
  std::apply([&](const auto&... member) { (visit(member, owner.*member.at), ...); },
             std::remove_cvref_t<Owner>::kMembers);
}

}  // namespace kith
