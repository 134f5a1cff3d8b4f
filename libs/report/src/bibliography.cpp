#include "bibliography.hpp"

#include <algorithm>
#include <cctype>

#include "kith/core/text.hpp"

namespace kith::detail {
namespace {

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

std::string trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return std::string{text};
}

// Where the brace that opens at `open` closes.
std::size_t closing(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '{') ++depth;
    if (text[i] == '}' && --depth == 0) return i;
  }
  return text.size();
}

// A value for people: no braces, one blank between words, one hyphen for a dash.
std::string plain(std::string_view value) {
  std::string text;
  for (const char c : value) {
    if (c == '{' || c == '}' || (c == '-' && text.ends_with('-'))) continue;
    if (!is_blank(c)) {
      text += c;
    } else if (!text.empty() && text.back() != ' ') {
      text += ' ';
    }
  }
  return trimmed(text);
}

std::map<std::string, std::string> fields_of(std::string_view body) {
  std::map<std::string, std::string> fields;
  for (std::size_t at = 0; at < body.size();) {
    const auto equals = body.find('=', at);
    const auto open = body.find('{', equals);
    if (equals == std::string_view::npos || open == std::string_view::npos) break;
    const auto close = closing(body, open);
    fields[trimmed(body.substr(at, equals - at))] = plain(body.substr(open + 1, close - open - 1));
    const auto comma = body.find(',', close);
    at = comma == std::string_view::npos ? body.size() : comma + 1;
  }
  return fields;
}

struct Author {
  std::string family;
  std::string initials;  // "S. K."
};

std::vector<Author> authors_of(const std::string& field) {
  std::vector<Author> authors;
  for (std::size_t at = 0; at <= field.size();) {
    const auto next = std::min(field.find(" and ", at), field.size());
    const auto name = field.substr(at, next - at);
    at = next + 5;
    const auto comma = name.find(", ");
    Author author{name.substr(0, comma), ""};
    bool begins = true;
    for (std::size_t i = comma == std::string::npos ? name.size() : comma + 2; i < name.size(); ++i) {
      if (begins && name[i] != ' ') author.initials += (author.initials.empty() ? "" : " ") + name.substr(i, 1) + ".";
      begins = name[i] == ' ';
    }
    authors.push_back(author);
  }
  return authors;
}

std::string field(const Reference& reference, const std::string& name) {
  const auto found = reference.fields.find(name);
  return found == reference.fields.end() ? "" : found->second;
}

// Where it appeared: "Journal, 3(2), 1-4".
std::string venue(const Reference& reference) {
  std::string text;
  for (const auto* name : {"journal", "booktitle", "howpublished", "institution", "publisher"}) {
    if (text.empty()) text = field(reference, name);
  }
  const auto volume = field(reference, "volume");
  const auto number = field(reference, "number");
  const auto pages = field(reference, "pages");
  if (!volume.empty()) text += ", " + volume + (number.empty() ? "" : "(" + number + ")");
  if (!pages.empty()) text += ", " + pages;
  return text;
}

}  // namespace

std::vector<Reference> parse_bibtex(std::string_view text) {
  std::vector<Reference> references;
  for (std::size_t at = text.find('@'); at != std::string_view::npos;) {
    const auto open = text.find('{', at);
    if (open == std::string_view::npos) break;
    const auto close = closing(text, open);
    const auto comma = text.find(',', open);
    if (comma == std::string_view::npos || comma > close) break;
    references.push_back({trimmed(text.substr(open + 1, comma - open - 1)), trimmed(text.substr(at + 1, open - at - 1)),
                          fields_of(text.substr(comma + 1, close - comma - 1)),
                          std::string{text.substr(at, close + 1 - at)}});
    at = text.find('@', close);
  }
  return references;
}

std::string reference_text(const Reference& reference) {
  const auto authors = authors_of(field(reference, "author"));
  const auto name = [](const auto& author) {
    return author.family + (author.initials.empty() ? "" : ", " + author.initials);
  };
  auto text =
      joined(authors, ", ", name, ", & ") + " (" + field(reference, "year") + "). " + field(reference, "title") + ".";
  const auto where = venue(reference);
  if (!where.empty()) text += " " + where + ".";
  return text;
}

std::string citation_text(const Reference& reference) {
  const auto authors = authors_of(field(reference, "author"));
  std::string text = authors.front().family;
  if (authors.size() == 2) text += " & " + authors[1].family;
  if (authors.size() > 2) text += " et al.";
  return text + ", " + field(reference, "year");
}

}  // namespace kith::detail
