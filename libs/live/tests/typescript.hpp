#pragma once

#include <set>
#include <string>
#include <type_traits>
#include <vector>

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
      const std::string name{T::kType};
      if (!name.empty() && !printed_.insert(name).second) return name;
      const auto fields = fields_of<T>(false, name.empty() ? "; " : ";\n  ");
      const auto others = others_of<T>();
      if (name.empty()) return "{ " + fields + " }" + others;
      const auto body = "{\n  " + fields + ";\n}" + others;
      text += "export " + (others.empty() ? "interface " + name + " " + body : "type " + name + " = " + body + ";") +
              "\n\n";
      return name;
    } else if constexpr (kIsOptional<T>) {
      return type_of<typename T::value_type>();
    } else {
      const auto element = type_of<typename T::value_type>();
      const bool is_one = element.find(' ') == std::string::npos || element.back() == '}';
      return is_one ? element + "[]" : "(" + element + ")[]";
    }
  }

  /// The interface of what this sender may ask for, by command.
  template <RoomSender kSender>
  void add_commands(const std::string& name) {
    text += "export interface " + name + " {\n";
    [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) { (add_command<kSender, kIndex>(), ...); }
    (std::make_index_sequence<std::variant_size_v<RoomHappening>>{});
    text += "}\n\n";
  }

  std::string text;

 private:
  // "of: number; ..." without what the server adds to a command, and the reason that all of facilitators have.
  template <typename Owner>
  std::string fields_of(bool is_command, const std::string& separator) {
    std::string all;
    const auto add = [&]<typename Part, typename T>(const Member<Part, T>& member) {
      if (member.name.empty() || (is_command && (!member.asked || member.name == "reason"))) return;
      auto type = std::string{member.type};
      if constexpr (!std::is_same_v<T, Json>) type = type.empty() ? type_of<T>() : type;
      if (type.empty()) return;
      if (kIsOptional<T> && !member.may_miss) type += " | null";
      const bool may_miss = member.may_miss || (member.asked && (member.asked->may_miss || kIsOptional<T>));
      all += (all.empty() ? "" : separator) + std::string{member.name} + (may_miss ? "?: " : ": ") + type;
    };
    std::apply([&](const auto&... member) { (add(member), ...); }, Owner::kMembers);
    return all;
  }

  // " & Path": types whose members stand among the others.
  template <typename Owner>
  std::string others_of() {
    std::string all;
    const auto add = [&]<typename Part, typename T>(const Member<Part, T>& member) {
      if (!member.name.empty()) return;
      if constexpr (std::is_same_v<T, Json>) {
        all += " & " + std::string{member.type};
      } else {
        all += " & Partial<" + type_of<T>() + ">";
      }
    };
    std::apply([&](const auto&... member) { (add(member), ...); }, Owner::kMembers);
    return all;
  }

  template <RoomSender kSender, std::size_t kIndex>
  void add_command() {
    using Event = std::variant_alternative_t<kIndex, RoomHappening>;
    if constexpr (kind_asked_for(kSender, Event::kKind.command) == kIndex) {
      const auto fields = fields_of<Event>(true, "; ");
      const auto body = fields.empty() ? "Record<string, never>" : "{ " + fields + " }";
      text += "  " + std::string{Event::kKind.command} + ": " + body + ";\n";
    }
  }

  std::set<std::string> printed_;
};

}  // namespace kith::testing
