#pragma once

// Included before every file of the engine: what the libraries use of C++20 and Emscripten's C++ library does not have.

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <compare>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

// Random123 refuses processors that it has not been tried on; the tests compare streams with those of the program.
#define __s390x__ 1
#include <Random123/features/compilerfeatures.h>
#undef __s390x__

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

template <class T>
constexpr auto operator<=>(const vector<T>& a, const vector<T>& b) -> decltype(a[0] <=> b[0]) {
  for (size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (const auto order = a[i] <=> b[i]; order != 0) return order;
  }
  return a.size() <=> b.size();
}

/// The nearest number to a decimal text, as the C library rounds it.
inline from_chars_result from_chars(const char* first, const char* last, double& value,
                                    chars_format = chars_format::general) {
  const char* p = first;
  if (p != last && *p == '-') ++p;
  const bool is_number = p != last && ((*p >= '0' && *p <= '9') || *p == '.' || *p == 'i' || *p == 'n');
  if (!is_number || (p + 1 < last && (p[1] == 'x' || p[1] == 'X'))) {
    if (!(is_number && *p == '0')) return {first, errc::invalid_argument};
    value = p == first ? 0.0 : -0.0;  // of "0x": the nought
    return {p + 1, errc{}};
  }
  const string text(first, last);
  char* end = nullptr;
  errno = 0;
  const double read = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  const char* const stop = first + (end - text.c_str());
  if (errno == ERANGE) return {stop, errc::result_out_of_range};
  value = read;
  return {stop, errc{}};
}

/// The shortest text that reads as the number: fixed, unless scientific is shorter.
to_chars_result to_chars(char* first, char* last, double value);
/// The shortest such text in the format.
to_chars_result to_chars(char* first, char* last, double value, chars_format format);
/// So many digits.
to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision);

namespace ranges {

// Those algorithms that are used, with projections. Every range here is one that std::begin() knows.
template <class R, class T, class P = std::identity>
constexpr auto find(R&& range, const T& value, P projection = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& x) { return std::invoke(projection, x) == value; });
}
template <class R, class F, class P = std::identity>
constexpr auto find_if(R&& range, F f, P projection = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& x) { return std::invoke(f, std::invoke(projection, x)); });
}
template <class R, class F, class P = std::identity>
constexpr bool any_of(R&& range, F f, P projection = {}) {
  return ranges::find_if(range, f, projection) != std::end(range);
}
template <class R, class F, class P = std::identity>
constexpr bool none_of(R&& range, F f, P projection = {}) {
  return !ranges::any_of(range, f, projection);
}
template <class R, class F, class P = std::identity>
constexpr bool all_of(R&& range, F f, P projection = {}) {
  return std::all_of(std::begin(range), std::end(range),
                     [&](auto&& x) { return std::invoke(f, std::invoke(projection, x)); });
}
template <class R, class F, class P = std::identity>
constexpr auto count_if(R&& range, F f, P projection = {}) {
  return std::count_if(std::begin(range), std::end(range),
                       [&](auto&& x) { return std::invoke(f, std::invoke(projection, x)); });
}

template <class R, class T, class P = std::identity>
constexpr auto count(R&& range, const T& value, P projection = {}) {
  return ranges::count_if(
      range, [&](auto&& x) { return x == value; }, projection);
}
template <class A, class B>
constexpr auto find_first_of(A&& a, B&& b) {
  return std::find_first_of(std::begin(a), std::end(a), std::begin(b), std::end(b));
}

namespace detail {
template <class C, class P>
constexpr auto by(C& compare, P& projection) {
  return [&](auto&& a, auto&& b) -> bool {
    return std::invoke(compare, std::invoke(projection, a), std::invoke(projection, b));
  };
}
}  // namespace detail

template <class R, class C = std::less<>, class P = std::identity>
constexpr auto max_element(R&& range, C compare = {}, P projection = {}) {
  return std::max_element(std::begin(range), std::end(range), detail::by(compare, projection));
}
template <class R, class C = std::less<>, class P = std::identity>
constexpr auto max(R&& range, C compare = {}, P projection = {}) {
  return *ranges::max_element(range, compare, projection);
}
template <class R, class C = std::less<>, class P = std::identity>
constexpr void sort(R&& range, C compare = {}, P projection = {}) {
  std::sort(std::begin(range), std::end(range), detail::by(compare, projection));
}
template <class R, class C = std::less<>, class P = std::identity>
constexpr void stable_sort(R&& range, C compare = {}, P projection = {}) {
  std::stable_sort(std::begin(range), std::end(range), detail::by(compare, projection));
}
template <class R, class C = std::less<>, class P = std::identity>
constexpr void make_heap(R&& range, C compare = {}, P projection = {}) {
  std::make_heap(std::begin(range), std::end(range), detail::by(compare, projection));
}
template <class R, class C = std::less<>, class P = std::identity>
constexpr void push_heap(R&& range, C compare = {}, P projection = {}) {
  std::push_heap(std::begin(range), std::end(range), detail::by(compare, projection));
}
template <class R, class C = std::less<>, class P = std::identity>
constexpr void pop_heap(R&& range, C compare = {}, P projection = {}) {
  std::pop_heap(std::begin(range), std::end(range), detail::by(compare, projection));
}
template <class R, class T, class C = std::less<>, class P = std::identity>
constexpr auto lower_bound(R&& range, const T& value, C compare = {}, P projection = {}) {
  return std::lower_bound(std::begin(range), std::end(range), value,
                          [&](auto&& x, const T& v) { return std::invoke(compare, std::invoke(projection, x), v); });
}
template <class A, class B, class C = std::equal_to<>, class P = std::identity, class Q = std::identity>
constexpr bool equal(A&& a, B&& b, C same = {}, P of_a = {}, Q of_b = {}) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b),
                    [&](auto&& x, auto&& y) { return std::invoke(same, std::invoke(of_a, x), std::invoke(of_b, y)); });
}
template <class A, class B>
constexpr bool is_permutation(A&& a, B&& b) {
  return std::is_permutation(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
template <class A, class B>
struct mismatch_result {
  A in1;
  B in2;
};
template <class A, class B>
constexpr auto mismatch(A&& a, B&& b) {
  const auto found = std::mismatch(std::begin(a), std::end(a), std::begin(b), std::end(b));
  return mismatch_result<decltype(found.first), decltype(found.second)>{found.first, found.second};
}
template <class R, class O, class F, class P = std::identity>
constexpr void copy_if(R&& range, O out, F f, P projection = {}) {
  std::copy_if(std::begin(range), std::end(range), out,
               [&](auto&& x) { return std::invoke(f, std::invoke(projection, x)); });
}

}  // namespace ranges
}  // namespace std
