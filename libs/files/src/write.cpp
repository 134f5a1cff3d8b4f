#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <variant>

#include "kith/files/document.hpp"

namespace kith {
namespace {

std::string as_string(std::string_view text) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      out += "\\u00";
      out += kHex[byte >> 4U];
      out += kHex[byte & 0xFU];
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string written_key(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? key : as_string(key);
}

std::string written_real(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text{buffer.data(), end};
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

void write_inline(const TomlValue& value, std::string& out);

struct InlineWriter {
  std::string& out;

  void operator()(bool value) const { out += value ? "true" : "false"; }
  void operator()(std::int64_t value) const { out += std::to_string(value); }
  void operator()(double value) const { out += written_real(value); }
  void operator()(const std::string& value) const { out += as_string(value); }
  void operator()(const TomlDateTime& value) const { out += value.text; }
  void operator()(const TomlArray& array) const {
    out += '[';
    for (std::size_t i = 0; i < array.size(); ++i) {
      if (i > 0) out += ", ";
      write_inline(array[i], out);
    }
    out += ']';
  }
  void operator()(const TomlTable& table) const {
    out += "{";
    bool first = true;
    for (const TomlEntry& entry : table.entries()) {
      out += first ? " " : ", ";
      first = false;
      out += written_key(entry.key) + " = ";
      write_inline(entry.value, out);
    }
    out += first ? "}" : " }";
  }
};

void write_inline(const TomlValue& value, std::string& out) { std::visit(InlineWriter{out}, value.content()); }

// Written as [[name]] blocks rather than inline.
bool is_array_of_tables(const TomlValue& value) {
  const TomlArray* array = value.array();
  return array != nullptr && !array->empty() &&
         std::all_of(array->begin(), array->end(), [](const TomlValue& v) { return v.table() != nullptr; });
}

void write_table(const TomlTable& table, const std::string& path, std::string& out) {
  for (const TomlEntry& entry : table.entries()) {
    if (entry.value.table() != nullptr || is_array_of_tables(entry.value)) continue;
    out += written_key(entry.key) + " = ";
    write_inline(entry.value, out);
    out += '\n';
  }
  for (const TomlEntry& entry : table.entries()) {
    const std::string name = path.empty() ? written_key(entry.key) : path + '.' + written_key(entry.key);
    if (const TomlTable* sub = entry.value.table()) {
      out += out.empty() ? "[" : "\n[";
      out += name + "]\n";
      write_table(*sub, name, out);
    } else if (is_array_of_tables(entry.value)) {
      for (const TomlValue& element : *entry.value.array()) {
        out += out.empty() ? "[[" : "\n[[";
        out += name + "]]\n";
        write_table(*element.table(), name, out);
      }
    }
  }
}

}  // namespace

std::string to_toml(const TomlTable& table) {
  std::string out;
  write_table(table, "", out);
  return out;
}

std::string to_toml(const TomlValue& value) {
  std::string out;
  write_inline(value, out);
  return out;
}

}  // namespace kith
