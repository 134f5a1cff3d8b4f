#include <algorithm>
#include <utility>

#include "kith/domains/family_map.hpp"

namespace kith::detail {
namespace {

bool is_name(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_name_character);
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

// Reads the legend: what each symbol stands for.
class LegendReader {
 public:
  LegendReader(FamilyMap& family_map, TomlReport& report) : family_map_{family_map}, report_{report} {}

  void read(const TomlTable& legend) {
    for (const TomlEntry& entry : legend.entries()) {
      if (!check_glyph(entry)) continue;
      Symbol symbol;
      symbol.glyph = entry.key.front();
      symbol.place = entry.place;
      if (entry.value.string() != nullptr) {
        read_short(entry.value, symbol);
      } else if (const TomlTable* table = entry.value.table()) {
        read_long(*table, entry, symbol);
      } else {
        report_.error("E0205", entry.value.place(),
                      std::string{"symbol '"} + symbol.glyph + "' must be a string or a table, not " +
                          std::string{entry.value.kind_name()});
      }
      family_map_.symbols.push_back(std::move(symbol));
    }
    collect_names();
  }

 private:
  bool check_glyph(const TomlEntry& entry) {
    const bool printable = entry.key.size() == 1 && entry.key[0] >= 0x20 && entry.key[0] < 0x7F;
    if (printable && entry.key != "@") return true;
    report_.error("E0204", entry.place,
                  "'" + entry.key + "' cannot be a symbol: it must be one printable ASCII character other than '@'",
                  entry.key == "@" ? "'@' is where the robot is drawn" : "");
    return false;
  }

  void read_short(const TomlValue& value, Symbol& symbol) {
    const std::string& word = *value.string();
    if (word == "wall") {
      symbol.content.wall = true;
    } else if (word != "floor") {
      const std::string nearest = nearest_word(word, {"wall", "floor"});
      report_.error(
          "E0205", value.place(), "a symbol alone can be \"wall\" or \"floor\", not \"" + word + "\"",
          nearest.empty() ? "for a terrain write { terrain = \"" + word + "\" }" : "did you mean '" + nearest + "'?");
    }
  }

  void read_long(const TomlTable& table, const TomlEntry& entry, Symbol& symbol) {
    TomlReader reader{table, entry.value.place(), std::string{"symbol '"} + symbol.glyph + "'", report_};
    SymbolContent& content = symbol.content;
    has_bad_name_ = false;

    content.wall = reader.boolean("wall", Presence::kOptional).value_or(false);
    content.start = reader.boolean("start", Presence::kOptional).value_or(false);
    content.terrain = name(reader, "terrain");
    content.station = name(reader, "station");
    content.item = name(reader, "item");
    content.destination = name(reader, "destination");
    content.carried = reader.boolean("carried", Presence::kOptional).value_or(false);

    if (content.carried && content.item.empty()) {
      report_.error("E0272", table.find("carried")->place(), "there is no item on the symbol that could be carried",
                    "write it beside item = \"NAME\"");
      content.carried = false;
    }

    if (const auto [set, word] = flag_or_name(reader, "goal"); set) {
      content.goal = true;
      content.goal_name = word;
    }
    if (const auto [set, word] = flag_or_name(reader, "optional", family_map_.is_picture); set) {
      symbol.toggles_each_cell = word.empty();
      symbol.toggle = word;
    }

    reader.finish();
    check(symbol, has_bad_name_);
  }

  std::string name(TomlReader& reader, std::string_view key) {
    const auto text = reader.string(key, Presence::kOptional);
    if (!text) return "";
    if (is_name(*text)) return *text;
    report_bad_name(*reader.content().find(key), *text);
    return "";
  }

  // `KEY = true` or `KEY = "NAME"`. @param any  names may have any characters.
  std::pair<bool, std::string> flag_or_name(TomlReader& reader, std::string_view key, bool any = false) {
    const TomlValue* value = reader.value(key, Presence::kOptional);
    if (value == nullptr) return {false, ""};
    if (const bool* flag = value->boolean()) return {*flag, ""};
    if (const std::string* text = value->string()) {
      if (is_name(*text) || (any && !text->empty())) return {true, *text};
      report_bad_name(*value, *text);
      return {false, ""};
    }
    report_.error("E0108", value->place(),
                  std::string{key} + " must be true or a name, not " + std::string{value->kind_name()});
    return {false, ""};
  }

  void report_bad_name(const TomlValue& value, const std::string& text) {
    has_bad_name_ = true;
    report_.error("E0225", value.place(), "'" + text + "' cannot be a name",
                  "use letters, digits, '_' and '-', as in 'quiet-hours'");
  }

  // @param has_bad_name  something is meant to be on it, but is called so that nobody can say it.
  void check(const Symbol& symbol, bool has_bad_name) {
    const SymbolContent& content = symbol.content;
    if (content.wall && content.start) {
      report_.error("E0209", symbol.place, "the robot cannot start on a wall");
    } else if (content.wall) {
      SymbolContent rest = content;
      rest.wall = false;
      if (!rest.is_floor()) report_.error("E0223", symbol.place, "a wall cell cannot contain anything else");
    }
    if (symbol.is_optional() && content.start) {
      report_.error("E0213", symbol.place, "the start cannot be optional");
    } else if (symbol.is_optional() && !content.destination.empty()) {
      report_.error("E0213", symbol.place, "a destination cannot be optional");
    } else if (symbol.is_optional() && content.is_floor() && !has_bad_name) {
      report_.error("E0213", symbol.place, "there is nothing on the symbol that could be optional");
    }
  }

  void collect_names() {
    for (const Symbol& symbol : family_map_.symbols) {
      const SymbolContent& content = symbol.content;
      add_once(family_map_.terrain_names, content.terrain);
      add_once(family_map_.station_names, content.station);
      add_once(family_map_.goal_names, content.goal_name);
      if (content.item.empty()) continue;
      const bool known = std::any_of(family_map_.items.begin(), family_map_.items.end(),
                                     [&](const Item& item) { return item.name == content.item; });
      if (known) {
        report_.error("E0211", symbol.place, "item '" + content.item + "' has two symbols; an item lies on one cell");
      } else {
        family_map_.items.push_back({content.item, {}, {}, content.carried});
      }
    }
    for (const Symbol& symbol : family_map_.symbols) check_references(symbol);
  }

  void check_references(const Symbol& symbol) {
    const SymbolContent& content = symbol.content;
    const auto& stations = family_map_.station_names;
    if (!content.terrain.empty() && std::find(stations.begin(), stations.end(), content.terrain) != stations.end()) {
      report_.error("E0214", symbol.place, "'" + content.terrain + "' is the name of a terrain and of a station",
                    "leave:" + content.terrain + " could mean either");
    }
    std::vector<std::string> items;
    for (const Item& item : family_map_.items) items.push_back(item.name);
    const auto is_in = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), content.destination) != names.end();
    };
    if (!content.destination.empty() && !is_in(items) && !is_in(family_map_.absent)) {
      report_.error("E0212", symbol.place, "destination of an unknown item '" + content.destination + "'",
                    suggestion(content.destination, items));
    }
  }

  FamilyMap& family_map_;
  TomlReport& report_;
  bool has_bad_name_ = false;  // the symbol that is being read
};

}  // namespace

void read_legend(const TomlTable& legend, FamilyMap& family_map, TomlReport& report) {
  LegendReader{family_map, report}.read(legend);
}

}  // namespace kith::detail
