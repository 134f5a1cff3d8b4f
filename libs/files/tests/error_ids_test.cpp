#include "error_ids.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "kith/files/reader.hpp"

namespace kith {
namespace {

void add_ids(const std::vector<Diagnostic>& diagnostics, std::set<std::string>& ids) {
  for (const Diagnostic& d : diagnostics) ids.insert(d.id);
}

// Everything that the layer can complain about, provoked.
std::set<std::string> triggered_ids() {
  std::set<std::string> ids;
  for (const std::string& text : {std::string{"a ="}, std::string{"a=1\na=2"}, std::string(kMaxTomlBytes + 1, '#'),
                                  "a=" + std::string(40, '['), std::string{"\xC3\xA9=1"}}) {
    add_ids(parse_toml(text, "a").diagnostics, ids);
  }
  add_ids(parse_assignment("x", "--set").diagnostics, ids);
  TomlDocument document = *parse_toml("b=1\nx=inf\nw=\"v\"\ns=1\nn=0\n", "a").document;
  add_ids(assign(document, *parse_assignment("b.c=1", "--set").assignment), ids);
  TomlReport report{document};
  TomlReader reader{document.root, {0, 1, 1, 1}, "the file", report};
  static_cast<void>(reader.string("missing", Presence::kRequired));
  static_cast<void>(reader.string("s", Presence::kRequired));
  static_cast<void>(reader.real("x", Presence::kRequired));
  static_cast<void>(reader.integer("n", Presence::kRequired, {1, 2}));
  static_cast<void>(reader.word("w", Presence::kRequired, {"q"}));
  reader.finish();
  add_ids(report.diagnostics(), ids);
  return ids;
}

TEST(TomlErrorIds, AreAllTriggeredHere) {
  auto ids = kith::testing::error_ids_in("files");
  std::erase_if(ids, [](const std::string& id) { return id >= "E0200"; });  // those of tables have tests of their own
  EXPECT_EQ(ids, triggered_ids());
}

}  // namespace
}  // namespace kith
