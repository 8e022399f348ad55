#include "signal/utf8.h"

#include <doctest/doctest.h>

using namespace kadans;

TEST_CASE("xml_characters leaves characters of every length and replaces each byte that is none") {
  const std::string good = "a\xc3\xa9\xe2\x82\xac\xf0\x9f\xa4\x96";
  CHECK(xml_characters(good) == good);
  CHECK(find_invalid_utf8(good) == std::string::npos);
  const std::string bad = "\xef\xbf\xbd";
  for (const char* one : {"\xff", "\x80", "\xc0", "\xc3", "\xf5"}) CHECK(xml_characters(one) == bad);
  CHECK(xml_characters("\xe2\x82") == bad + bad);             // cut short
  CHECK(xml_characters("\xc0\xaf") == bad + bad);             // longer than it needs to be
  CHECK(xml_characters("\xed\xa0\x80") == bad + bad + bad);   // half of a pair
  CHECK(xml_characters("\xf4\x90\x80\x80").size() == 4 * 3);  // beyond the last
  CHECK(find_invalid_utf8("ab\xff") == 2);
  CHECK(xml_characters("").empty());
}

TEST_CASE("xml_characters leaves out what no writing makes a character of XML") {
  CHECK(xml_characters("a\tb\nc\r\x01\x1f\x7f") == "a\tb\nc\r\x7f");
  CHECK(xml_characters("\xef\xbf\xbe|\xef\xbf\xbf|\xef\xbf\xbd") == "||\xef\xbf\xbd");
  CHECK(xml_characters("\xff") == "\xef\xbf\xbd");
}

TEST_CASE("append_utf8 writes what utf8_length reads, of every length") {
  for (const std::uint32_t code : {0x41U, 0x7FU, 0x80U, 0x7FFU, 0x800U, 0x28FFU, 0xFFFDU, 0x10000U, 0x10FFFFU}) {
    std::string text;
    append_utf8(code, text);
    CAPTURE(code);
    CHECK(utf8_length(text, 0) == text.size());
  }
  std::string text;
  append_utf8(0x20ACU, text);
  CHECK(text == "\xe2\x82\xac");
}

TEST_CASE("shown_text lets no character through that a terminal obeys, whichever way it is written") {
  const std::string good = "a\tb\n\xc3\xa9\xe2\x82\xac\xf0\x9f\xa4\x96\xc2\xa0";
  CHECK(shown_text(good) == good);
  CHECK(shown_text("\033[2J\r\x7f") == "?[2J??");
  CHECK(shown_text("\xc2\x9b"
                   "31m|\xc2\x80|\xc2\x85|\xc2\x9f") == "?31m|?|?|?");  // C1: the CSI of eight bits
  CHECK(shown_text("\x9b"
                   "31m\xff") == "?31m?");  // the same as bytes that are no UTF-8
  CHECK(shown_text("\xe2\x80\xae|\xe2\x81\xa6|\xe2\x80\x8f|\xd8\x9c") == "?|?|?|?");  // they turn what is beside them
  CHECK(shown_text("\xe2\x80\xa8|\xe2\x80\x94") == "?|\xe2\x80\x94");                 // a dash stays
}
