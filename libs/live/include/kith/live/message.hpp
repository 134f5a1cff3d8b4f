#pragma once

#include <algorithm>
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

/// A member of an event or of a view by its name in JSON. Without a name, its own members stand in its place.
template <typename Owner, typename T>
struct Member {
  std::string_view name;
  bool may_miss = false;  ///< Left out unless it is set.
  T Owner::*at = nullptr;
  std::string_view type{};        ///< In TypeScript; empty: that of T.
  std::optional<Limits> asked{};  ///< What commands may say of it; nothing: it is not asked for.
  [[nodiscard]] constexpr bool is_stored() const { return !asked || asked->is_stored; }
};

/// A tuple of members: of each its name, with '?' if it is left out unless it is set, a pointer to it and, if it is
/// asked for, its limits.
constexpr std::tuple<> members() { return {}; }
template <typename Owner, typename T, typename... Rest>
constexpr auto members(std::string_view name, T Owner::*at, const Rest&... rest) {
  const auto end = name.find('?');
  const Member<Owner, T> member{name.substr(0, end), end != std::string_view::npos, at};
  return std::tuple_cat(std::tuple{member}, members(rest...));
}
template <typename Owner, typename T, typename... Rest>
constexpr auto members(std::string_view name, T Owner::*at, const Limits& limits, const Rest&... rest) {
  auto first = members(name, at);
  std::get<0>(first).type = limits.type;
  std::get<0>(first).asked = limits;
  return std::tuple_cat(first, members(rest...));
}

/// Calls visit(member, value) for every member of an event or view.
template <typename Owner, typename Visit>
constexpr void for_each_member(Owner& owner, Visit visit) {
  std::apply([&](const auto&... member) { (visit(member, owner.*member.at), ...); },
             std::remove_cvref_t<Owner>::kMembers);
}

/// A text as an argument of a template.
template <std::size_t kSize>
struct Name {
  constexpr Name(const char (&text)[kSize]) { std::copy_n(text, kSize, chars); }  // NOLINT(google-explicit-constructor)
  [[nodiscard]] constexpr std::string_view view() const { return {chars, kSize - 1}; }
  char chars[kSize]{};
};

/// A field of a record, with its type in TypeScript where that is not T's.
template <Name kName, typename T, Name kType = "", bool kMayMiss = false>
struct Field {
  using Value = T;
  T value{};
  static constexpr Member<Field, T> member() { return {kName.view(), kMayMiss, &Field::value, kType.view()}; }
};
/// Left out unless it is set.
template <Name kName, typename T, Name kType = "">
using IfSet = Field<kName, T, kType, true>;
template <Name kName, typename T, Name kType = "">
using Maybe = Field<kName, std::optional<T>, kType, true>;

/// What is shown, made of fields: record.at<"name">(). Its name is that of the interface in TypeScript; without one it
/// is written out where it is used.
template <Name kName, typename... Fields>
struct Record : Fields... {
  Record() = default;
  Record(typename Fields::Value... values)  // NOLINT(google-explicit-constructor): {1, "text"} is a record
      : Fields{std::move(values)}... {}

  template <Name kField>
  [[nodiscard]] auto& at() {
    return value_of<kField>(*this);
  }

  static constexpr std::string_view kType = kName.view();
  static constexpr auto kMembers = std::tuple{Fields::member()...};

 private:
  template <Name kField, typename T, Name kAs, bool kMayMiss>
  static T& value_of(Field<kField, T, kAs, kMayMiss>& field) {
    return field.value;
  }
};

}  // namespace kith
