#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "kith/live/room_event.hpp"
#include "message_json.hpp"
#include "room_body.hpp"

namespace kith::testing {

/// Prints types of TypeScript from the members of events and views.
class TypeScript {
 public:
  /// The type of a C++ type; what has a name is printed as an interface first.
  template <typename T>
  std::string type_of() {
    if constexpr (std::is_same_v<T, bool>) {
      return "boolean";
    } else if constexpr (std::is_arithmetic_v<T>) {
      return "number";
    } else if constexpr (std::is_same_v<T, std::string>) {
      return "string";
    } else if constexpr (HasMembers<T>) {
      return T::kType.empty() ? "{ " + joined<T>("; ") + " }" + spread<T>() : named<T>();
    } else {
      return element_of(static_cast<const T*>(nullptr));
    }
  }

  /// The interface of what this sender may ask for, by command.
  template <RoomSender kSender>
  void add_commands(const std::string& name) {
    std::string members;
    [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) { ((members += command<kSender, kIndex>()), ...); }
    (std::make_index_sequence<std::variant_size_v<RoomHappening>>{});
    text_ += "export interface " + name + " {\n" + members + "}\n\n";
  }

  void add(std::string_view text) { text_ += text; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  template <typename T>
  std::string named() {
    const std::string name{T::kType};
    if (std::find(printed_.begin(), printed_.end(), name) != printed_.end()) return name;
    printed_.push_back(name);
    const auto members = joined<T>(";\n  ");
    if (const auto more = spread<T>(); !more.empty()) {
      text_ += "export type " + name + " = {\n  " + members + ";\n}" + more + ";\n\n";
    } else {
      text_ += "export interface " + name + " {\n  " + members + ";\n}\n\n";
    }
    return name;
  }

  template <typename T>
  std::string element_of(const std::optional<T>*) {
    return type_of<T>();
  }
  template <typename T>
  std::string element_of(const std::vector<T>*) {
    const auto element = type_of<T>();
    const bool is_one = element.find(' ') == std::string::npos || element.back() == '}';
    return is_one ? element + "[]" : "(" + element + ")[]";
  }

  // "of: number"; nothing of members that another one's stand in place of, and of what the server adds to a command.
  template <typename Owner, typename T>
  std::string line_of(const Member<Owner, T>& member) {
    if (member.name.empty() || (std::is_same_v<T, Json> && member.type.empty())) return {};
    const bool may_miss = member.may_miss || (member.asked && (member.asked->may_miss || kIsOptional<T>));
    auto type = std::string{member.type};
    if constexpr (!std::is_same_v<T, Json>) type = type.empty() ? type_of<T>() : type;
    if (kIsOptional<T> && !member.may_miss) type += " | null";
    return std::string{member.name} + (may_miss ? "?: " : ": ") + type;
  }

  template <typename T>
  std::string joined(const std::string& separator, bool is_command = false) {
    std::string all;
    const T none{};
    for_each_member(none, [&](const auto& member, const auto&) {
      const bool is_reason = is_command && member.name == "reason";
      if (is_reason || (is_command && !member.asked)) return;
      if (const auto line = line_of(member); !line.empty()) all += (all.empty() ? "" : separator) + line;
    });
    return all;
  }

  // " & Path": types whose members stand among the others.
  template <typename T>
  std::string spread() {
    std::string all;
    const T none{};
    for_each_member(none, [&]<typename V>(const auto& member, const V&) {
      if (!member.name.empty()) return;
      if constexpr (std::is_same_v<V, Json>) {
        all += " & " + std::string{member.type};
      } else {
        all += " & Partial<" + type_of<V>() + ">";
      }
    });
    return all;
  }

  template <RoomSender kSender, std::size_t kIndex>
  std::string command() {
    using Event = std::variant_alternative_t<kIndex, RoomHappening>;
    if constexpr (kind_asked_for(kSender, Event::kKind.command) != kIndex) {
      return {};
    } else {
      const auto members = joined<Event>("; ", true);
      const auto body = members.empty() ? "Record<string, never>" : "{ " + members + " }";
      return "  " + std::string{Event::kKind.command} + ": " + body + ";\n";
    }
  }

  std::vector<std::string> printed_;
  std::string text_;
};

}  // namespace kith::testing
