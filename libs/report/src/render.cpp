#include <nlohmann/json.hpp>
#include <stdexcept>

#include "kith/report/report.hpp"

namespace kith {
namespace {

// Inside a script element "<" could begin its end or a comment; elsewhere than in strings JSON has none. A document of
// ours is ASCII, but whoever calls may have another: U+2028 and U+2029 end lines in scripts.
std::string escaped_for_script(std::string_view json) {
  std::string text;
  text.reserve(json.size() + json.size() / 64);
  for (std::size_t i = 0; i < json.size(); ++i) {
    const auto rest = json.substr(i, 3);
    if (json[i] == '<') {
      text += "\\u003c";
    } else if (rest == "\xE2\x80\xA8" || rest == "\xE2\x80\xA9") {
      text += rest.back() == '\xA8' ? "\\u2028" : "\\u2029";
      i += 2;
    } else {
      text += json[i];
    }
  }
  return text;
}

std::string escaped_for_html(std::string_view plain) {
  std::string text;
  for (const char c : plain) {
    switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '>':
        text += "&gt;";
        break;
      default:
        text += c;
    }
  }
  return text;
}

std::size_t place_of(std::string_view page, std::string_view placeholder) {
  const auto at = page.find(placeholder);
  if (at == std::string_view::npos || page.find(placeholder, at + 1) != std::string_view::npos) {
    throw std::invalid_argument{"render_report: the page must have " + std::string{placeholder} + " once"};
  }
  return at;
}

}  // namespace

std::string render_report(std::string_view document, std::string_view page) {
  const auto parsed = nlohmann::json::parse(document, nullptr, false);
  if (!parsed.is_object() || !parsed.contains("title") || !parsed.at("title").is_string()) {
    throw std::invalid_argument{"render_report: the document must be a JSON object with a title"};
  }
  struct Gap {
    std::size_t at;
    std::size_t length;
    std::string text;
  };
  Gap first{place_of(page, kTitlePlaceholder), kTitlePlaceholder.size(),
            escaped_for_html(parsed.at("title").get<std::string>())};
  Gap second{place_of(page, kDocumentPlaceholder), kDocumentPlaceholder.size(), escaped_for_script(document)};
  if (second.at < first.at) std::swap(first, second);
  std::string text;
  text.reserve(page.size() + first.text.size() + second.text.size());
  text += page.substr(0, first.at);
  text += first.text;
  text += page.substr(first.at + first.length, second.at - first.at - first.length);
  text += second.text;
  text += page.substr(second.at + second.length);
  return text;
}

}  // namespace kith
