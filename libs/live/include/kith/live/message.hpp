#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
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

/// The type of JSON in TypeScript, where nothing else is said of it.
struct As {
  std::string_view type;
};

/// A member of an event or of a view by its name in JSON. Without a name, its own members stand in its place.
template <typename Owner, typename T>
struct Member {
  std::string_view name;
  bool may_miss = false;  ///< Left out unless it is set.
  T Owner::*at = nullptr;
  std::string_view type{};        ///< In TypeScript; empty: that of T.
  std::optional<Limits> asked{};  ///< What commands may say of it; nothing: it is not asked for.
};

/// A tuple of members: of each its name, with '?' if it is left out unless it is set, a pointer to it and, if need be,
/// an As or its Limits.
constexpr std::tuple<> members() { return {}; }
template <typename Owner, typename T, typename... Rest>
constexpr auto members(std::string_view name, T Owner::*at, const Rest&... rest) {
  const auto end = name.find('?');
  const Member<Owner, T> member{name.substr(0, end), end != std::string_view::npos, at};
  if constexpr (sizeof...(Rest) > 0) {
    return [&]<typename Next>(const Next& next, const auto&... others) {
      auto with = member;
      if constexpr (std::is_same_v<Next, Limits>) with.asked = next, with.type = next.type;
      if constexpr (std::is_same_v<Next, As>) with.type = next.type;
      if constexpr (std::is_same_v<Next, Limits> || std::is_same_v<Next, As>) {
        return std::tuple_cat(std::tuple{with}, members(others...));
      } else {
        return std::tuple_cat(std::tuple{with}, members(next, others...));
      }
    }(rest...);
  } else {
    return std::tuple{member};
  }
}

/// Calls visit(member, value) for every member of an event or view.
template <typename Owner, typename Visit>
constexpr void for_each_member(Owner& owner, Visit visit) {
  std::apply([&](const auto&... member) { (visit(member, owner.*member.at), ...); },
             std::remove_cvref_t<Owner>::kMembers);
}

}  // namespace kith
