// What --plot draws and says, films, and the small picture in a terminal.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell.hpp"

namespace continuo::app::pictures_test {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* orbit = "x'' = -x\nx(0) = 1\nx'(0) = 0\ny'' = -y\ny(0) = 0\ny'(0) = 1\nparam T = 2\nrun 0..6\n";
constexpr const char* ball =
    "h'' = -10\nh(0) = 1\nh'(0) = 0\nwhen h falls through 0 { h' := -h' }\ndraw { floor 0\nball (0, h) radius 0.1 }\n"
    "run 0..0.5 realtime\n";

bool has_gnuplot() {
  return std::system("command -v gnuplot >/dev/null") == 0;
}

TEST(Pictures, PlotsInWordsAreDrawn) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  shell.write("orbit.sim", orbit);
  ASSERT_EQ(shell.run("run orbit.sim --plot a.svg --plot 'y against x; x^2 against t log y' --plot 'hypot(x, y)'").exit,
            0);
  EXPECT_THAT(shell.read("a.svg"), AllOf(HasSubstr("hypot(x, y)"), HasSubstr("x^2"), HasSubstr("</svg>")));
  ASSERT_EQ(shell.run("run orbit.sim --plot a.pdf --size 400x300").exit, 0);
  EXPECT_EQ(shell.read("a.pdf").substr(0, 4), "%PDF");
  ASSERT_EQ(shell.run("run orbit.sim --plot a.png --size 400x300").exit, 0);
  const std::string png = shell.read("a.png");
  EXPECT_EQ(png.substr(16, 8), (std::string("\0\0\x01\x90\0\0\x01\x2C", 8)));
  shell.write("family.sim", "param N = 4\nfor i in 1..N { u[i]' = i\nu[i](0) = 0 }\nrun 0..2\n");
  ASSERT_EQ(shell.run("run family.sim --plot f.svg --plot 'u[1..N] against index at 0, 1, 3/2'").exit, 0);
  EXPECT_THAT(shell.read("f.svg"), AllOf(HasSubstr("t = 0"), HasSubstr("t = 1.5"), HasSubstr("u[1..N]")));
}

TEST(Pictures, AMistakeInTheWordsIsShownAtItsPlace) {
  const Shell shell;
  shell.write("orbit.sim", orbit);
  const auto error = [&](const std::string& words) {
    const Result result = shell.run("run orbit.sim --plot a.svg --plot '" + words + "'");
    EXPECT_EQ(result.exit, 1) << words;
    EXPECT_THAT(result.out, IsEmpty()) << words;
    return result.err;
  };
  EXPECT_THAT(error("x, yy against x"), AllOf(HasSubstr("--plot:1:4"), HasSubstr("there is no `yy`"), HasSubstr("^^")));
  EXPECT_THAT(error("x; hypto(x, y)"), AllOf(HasSubstr("--plot:1:4"), HasSubstr("hypot")));
  EXPECT_THAT(error("x[1..S] against index at 0"), HasSubstr("`S` is neither a number nor a parameter"));
  EXPECT_THAT(error("x[1..2] against index"), HasSubstr("no time is named"));
  EXPECT_THAT(error("x against"), HasSubstr("against is missing"));
  EXPECT_THAT(error("x at"), HasSubstr("the times are missing"));
  EXPECT_THAT(error("x,, y"), HasSubstr("missing between commas"));
  EXPECT_THAT(error("x[1..1000000000] at 0"), HasSubstr("at most 100000"));
  EXPECT_THAT(error(""), Not(IsEmpty()));
  EXPECT_THAT(error("x against log y"), HasSubstr("for a logarithm log(x)"));
  EXPECT_THAT(shell.run("run orbit.sim --plot x").err, HasSubstr("add --plot FILE.svg"));
  EXPECT_EQ(shell.run("run orbit.sim --plot a.svg --plot b.svg").exit, 1);
  EXPECT_THAT(shell.run("run orbit.sim --plot a.jpg").err, HasSubstr("ends in .svg, .png or .pdf"));
  EXPECT_EQ(shell.run("run orbit.sim --plot a.svg --size 10").exit, 1);
}

/// Decodes the pictures of a GIF and lays them over one another; the number of pictures, -1 where it is broken.
class GifReader {
 public:
  explicit GifReader(std::string bytes) : bytes_(std::move(bytes)) {}

  int pictures() {
    if (bytes_.substr(0, 6) != "GIF89a") return -1;
    width = word(6), height = word(8);
    screen.assign(width * height, -1);
    at_ = 13 + 3 * 256;
    for (int count = 0; at_ < bytes_.size();) {
      const auto kind = byte();
      if (kind == 0x3B) return at_ == bytes_.size() ? count : -1;
      if (kind == 0x21) {
        ++at_;
        blocks();
      } else if (kind != 0x2C || !picture()) {
        return -1;
      } else {
        ++count;
      }
    }
    return -1;
  }
  std::array<int, 3> color(std::size_t x, std::size_t y) const {
    const std::size_t place = 13 + 3 * static_cast<std::size_t>(screen[y * width + x]);
    std::array<int, 3> rgb{};
    for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<unsigned char>(bytes_[place + k]);
    return rgb;
  }
  std::size_t width = 0, height = 0;
  std::vector<int> screen;

 private:
  std::size_t word(std::size_t at) const {
    return static_cast<unsigned char>(bytes_[at]) + 256U * static_cast<unsigned char>(bytes_[at + 1]);
  }
  unsigned byte() { return static_cast<unsigned char>(bytes_.at(at_++)); }
  std::string blocks() {
    std::string all;
    while (const unsigned length = byte()) {
      all += bytes_.substr(at_, length);
      at_ += length;
    }
    return all;
  }
  bool picture() {
    const std::size_t left = word(at_), top = word(at_ + 2), wide = word(at_ + 4), high = word(at_ + 6);
    at_ += 9;
    const unsigned bits = byte();
    const std::vector<int> pixels = decoded(blocks(), bits);
    if (pixels.size() != wide * high || left + wide > width || top + high > height) return false;
    for (std::size_t y = 0; y < high; ++y)
      for (std::size_t x = 0; x < wide; ++x) screen[(top + y) * width + left + x] = pixels[y * wide + x];
    return true;
  }
  /// LZW as appendix F of the standard tells a decoder to do it.
  static std::vector<int> decoded(const std::string& data, unsigned first_bits) {
    const std::size_t clear = 1U << first_bits;
    std::vector<std::vector<int>> words;
    std::vector<int> pixels, before;
    unsigned bits = first_bits + 1;
    std::uint32_t waiting = 0;
    unsigned count = 0;
    for (const char c : data) {
      waiting |= static_cast<std::uint32_t>(static_cast<unsigned char>(c)) << count;
      count += 8;
      while (count >= bits) {
        const std::size_t code = waiting & ((1U << bits) - 1);
        waiting >>= bits;
        count -= bits;
        if (code == clear) {
          words.assign(clear + 2, {});
          for (std::size_t i = 0; i < clear; ++i) words[i] = {static_cast<int>(i)};
          bits = first_bits + 1;
          before.clear();
          continue;
        }
        if (code == clear + 1) return pixels;
        if (code > words.size() || (code == words.size() && before.empty())) return {};
        std::vector<int> word = code < words.size() ? words[code] : before;
        if (code == words.size()) word.push_back(before.front());
        if (!before.empty() && words.size() < 4096) {
          before.push_back(word.front());
          words.push_back(before);
        }
        if (words.size() == 1U << bits && bits < 12) ++bits;
        pixels.insert(pixels.end(), word.begin(), word.end());
        before = word;
      }
    }
    return {};
  }

  std::string bytes_;
  std::size_t at_ = 0;
};

TEST(Pictures, AFilmOfTheSceneIsAGifThatAnyoneCanDecode) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  shell.write("ball.sim", ball);
  const Result result = shell.run("run ball.sim --plot ball.gif");
  ASSERT_EQ(result.exit, 0) << result.err;
  GifReader gif(shell.read("ball.gif"));
  EXPECT_THAT(gif.pictures(), AnyOf(16, 17));  // half a second, thirty each, the first, and one at the end
  EXPECT_EQ(gif.width, 960U);
  EXPECT_EQ(gif.height, 720U);
  for (const int channel : gif.color(2, 2)) EXPECT_GE(channel, 250);
  EXPECT_FALSE(shell.has("ball.gif.part"));
  EXPECT_THAT(shell.run("run ball.sim --plot ball.gif --plot h").err, HasSubstr("shows the scene"));
}

// A mass on a long spring: the picture is higher than the scene, and what is left over is above the floor.
TEST(Pictures, AFilmShowsLittleOfWhatIsBelowAFloor) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  shell.write("slide.sim",
              "x' = 1\nx(0) = 0\ndraw { floor 0\nbox (x, 0.1) size (0.2, 0.2) color \"red\" }\nrun 0..4 realtime\n");
  ASSERT_EQ(shell.run("run slide.sim --until 0.1 --plot slide.gif").exit, 0);
  GifReader gif(shell.read("slide.gif"));
  ASSERT_GE(gif.pictures(), 4);
  std::size_t ground = 0;  // pixels of one column
  for (std::size_t y = 0; y < gif.height; ++y) {
    const auto [red, green, blue] = gif.color(gif.width / 4, y);
    if (std::abs(red - 0xE6) < 5 && std::abs(green - 0xEA) < 5 && std::abs(blue - 0xF0) < 5) ++ground;
  }
  EXPECT_GT(ground, gif.height / 20);
  EXPECT_LT(ground, gif.height / 5);
}

// A wall of two triangles hides the ball behind it, half of the one that looks out beside it, and nothing of the ball
// before it.
TEST(Pictures, GroundHidesWhatIsBehindIt) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  shell.write("wall.obj", "v 5 1 0\nv -1 -5 0\nv -1 -5 4\nv 5 1 4\nf 1 2 3 4\n");
  const auto colored = [&](const std::string& place, const std::string& wall) {
    shell.write("wall.sim", "world { dimension 3\n mode fast step 1/60\n" + wall + " body ball at " + place +
                                " radius 0.4\n body other at (5, 1, -3) radius 0.1 fixed }\nrun 0..0.1 realtime\n");
    EXPECT_EQ(shell.run("run wall.sim --plot wall.gif").exit, 0);
    GifReader gif(shell.read("wall.gif"));
    EXPECT_GE(gif.pictures(), 1);
    std::size_t blue = 0;
    for (std::size_t y = 0; y < gif.height; ++y)
      for (std::size_t x = 0; x < gif.width; ++x) {
        const auto [red, green, of_blue] = gif.color(x, y);
        if (of_blue > red + 60) ++blue;
      }
    return blue;
  };
  const std::string wall = " wall it mesh \"wall.obj\" thin\n";
  const std::size_t whole = colored("(3, -3, 2)", wall), hidden = colored("(1, -1, 2)", wall);
  EXPECT_GT(whole, 300U);
  EXPECT_EQ(hidden, 0U);
  const std::size_t part = colored("(4, 2, 2)", wall);  // at the edge of the wall, and behind it
  EXPECT_GT(part, whole / 4);
  EXPECT_LT(part, whole * 3 / 4);
}

TEST(Pictures, AnInterruptedFilmLeavesWhatWasThere) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  shell.write("ball.sim", ball);
  shell.write("ball.gif", "kept");
  shell.call("timeout -s INT 2 '" CONTINUO_COMMAND "' run ball.sim --plot ball.gif --until 100");
  EXPECT_EQ(shell.read("ball.gif"), "kept");
  EXPECT_FALSE(shell.has("ball.gif.part"));
}

/// In a terminal of its own.
std::string in_terminal(const Shell& shell, const std::string& variables, const std::string& options) {
  return shell
      .call("env -u NO_COLOR -u TMUX -u TERM_PROGRAM TERM=xterm-256color LC_ALL=C.UTF-8 " + variables +
            " script -qec \"'" CONTINUO_COMMAND "' run orbit.sim " + options + "\" /dev/null")
      .out;
}

/// RFC 4648, section 4; nothing where it is broken.
std::string from_base64(std::string_view text) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (text.size() % 4 != 0) return {};
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  std::uint32_t waiting = 0;
  unsigned count = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) return {};
    waiting = (waiting << 6U) | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((waiting >> count) & 0xFFU);
  }
  return bytes;
}

void expect_png(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(bytes.size() - std::min<std::size_t>(8, bytes.size()), 4), "IEND");
}

// https://sw.kovidgoyal.net/kitty/graphics-protocol: pieces of at most 4096 characters, all but the last of a multiple
// of four and with m=1, the keys in the first.
TEST(Pictures, KittyGetsAPictureInPiecesOfItsProtocol) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  shell.write("orbit.sim", orbit);
  const std::string out = in_terminal(shell, "TERM=xterm-kitty", "");
  std::string text;
  std::size_t pieces = 0, end = 0;
  bool is_last = false;
  for (std::size_t at = out.find("\033_G"); at != std::string::npos; at = out.find("\033_G", end)) {
    EXPECT_FALSE(is_last);
    const std::size_t keys = at + 3, payload = out.find(';', at) + 1;
    end = out.find("\033\\", at);
    ASSERT_NE(end, std::string::npos);
    const std::string said = "," + out.substr(keys, payload - 1 - keys) + ",";
    is_last = said.find(",m=1,") == std::string::npos;
    if (pieces++ == 0) {
      EXPECT_THAT(said, AllOf(HasSubstr(",a=T,"), HasSubstr(",f=100,")));
    }
    EXPECT_LE(end - payload, 4096u);
    EXPECT_TRUE(is_last || (end - payload) % 4 == 0) << pieces;
    text += out.substr(payload, end - payload);
  }
  EXPECT_TRUE(is_last);
  expect_png(from_base64(text));
}

// https://iterm2.com/documentation-images.html: the size is that of the decoded file.
TEST(Pictures, ITermGetsAPictureWithItsSize) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  shell.write("orbit.sim", orbit);
  const std::string out = in_terminal(shell, "TERM_PROGRAM=iTerm.app", "");
  const std::size_t at = out.find("\033]1337;File="), colon = out.find(':', at), end = out.find('\a', at);
  ASSERT_LT(colon, end);
  ASSERT_NE(end, std::string::npos);
  const std::string picture = from_base64(std::string_view(out).substr(colon + 1, end - colon - 1));
  expect_png(picture);
  EXPECT_THAT(out.substr(at, colon - at) + ";",
              AllOf(HasSubstr("inline=1;"), HasSubstr("size=" + std::to_string(picture.size()) + ";")));
}

TEST(Pictures, ATerminalGetsASketchAndNothingElseDoes) {
  if (std::system("command -v script >/dev/null") != 0) GTEST_SKIP() << "script (bsdutils) is not installed";
  const Shell shell;
  shell.write("orbit.sim", orbit);
  constexpr const char* axis = "└";
  EXPECT_THAT(in_terminal(shell, "", ""), HasSubstr(axis));
  EXPECT_THAT(in_terminal(shell, "", "--plot 'y against x'"), HasSubstr(axis));
  EXPECT_THAT(in_terminal(shell, "", "--no-sketch"), Not(HasSubstr(axis)));
  EXPECT_THAT(in_terminal(shell, "NO_COLOR=1", ""), Not(HasSubstr(axis)));
  EXPECT_THAT(in_terminal(shell, "TERM=dumb", ""), Not(HasSubstr(axis)));
  EXPECT_THAT(in_terminal(shell, "LC_ALL=C", ""), Not(HasSubstr(axis)));
  EXPECT_THAT(in_terminal(shell, "", "--json"), Not(HasSubstr(axis)));
  EXPECT_THAT(shell.run("run orbit.sim").out, Not(HasSubstr(axis)));
  if (!has_gnuplot()) return;
  EXPECT_THAT(in_terminal(shell, "TERM=xterm-kitty", ""), HasSubstr("\033_Ga=T,f=100,q=2"));
  EXPECT_THAT(in_terminal(shell, "TERM_PROGRAM=iTerm.app", ""), HasSubstr("\033]1337;File=inline=1"));
  EXPECT_THAT(in_terminal(shell, "TERM=xterm-kitty TMUX=1", ""), Not(HasSubstr("\033_G")));
}

}  // namespace
}  // namespace continuo::app::pictures_test
