// SPDX-License-Identifier: BSD-3-Clause
// Stills and videos of a motion: the page of the report makes them, in a browser without a window.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <zlib.h>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/base/version.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/exports/browser.h"
#include "livens/io/exports/formats.h"
#include "livens/io/json.h"
#include "livens/io/report.h"

namespace livens {

namespace {

struct Kind {
    std::string_view word;
    int width, height;   ///< px, unless others are given
    double rate;         ///< frames a second, likewise; 0: a still
    double most_rate = 0;
};
constexpr Kind kinds[] = {
    {"png", 1920, 1080, 0}, {"svg", 1280, 720, 0}, {"webm", 1280, 720, 30, 240}, {"gif", 640, 400, 20, 50}};
constexpr int least_side = 16, most_side = 8192;                 // px, as the page has it
constexpr double most_frames = 20'000;                           // likewise
constexpr double least_duration = 0.01, most_duration = 86400;   // s
constexpr int frame_looks = 60;   // at what happens between frames, as the page does
constexpr double bent = 0.25;     // off a straight line between frames, as a part of it: a third of a turn
// s of video for so many of motion; a shorter or longer motion is slowed or hurried to the usual length
constexpr double short_span = 2, long_span = 40, usual_duration = 8;

[[noreturn]] void refuse_picture(const std::string& key, const std::string& value, const std::string& bound,
                                 const std::string& message)
{
    throw InputError({"picture", key, message, value, bound, "", ""});
}

void check_number(const char* key, double x, double least, double most)
{
    if (!(x >= least && x <= most))
        refuse_picture(key, to_text(x), to_text(least) + " to " + to_text(most),
                       std::string("'") + key + "' is out of range");
}

/// Part of the motion, its length in the video and the frames a second.
struct Course {
    double from, to, duration, rate;
};

Course course_of(const PictureOptions& o, const Motion& motion, const Kind& kind)
{
    Course c{std::isnan(o.from) ? motion.start() : o.from, std::isnan(o.to) ? motion.end() : o.to, 0,
             o.rate != 0 ? o.rate : kind.rate};
    check_number("from", c.from, motion.start(), motion.end());
    if (kind.rate == 0) return c;
    check_number("to", c.to, motion.start(), motion.end());
    if (!(c.to > c.from)) refuse_picture("to", to_text(c.to), "", "'to' must be after 'from'");
    check_number("fps", c.rate, 1, kind.most_rate);
    const double span = c.to - c.from;
    if (o.duration != 0) check_number("duration", o.duration, least_duration, most_duration);
    c.duration = o.duration != 0                           ? o.duration
                 : span >= short_span && span <= long_span ? span
                                                           : usual_duration;
    if (c.duration * c.rate > most_frames)
        refuse_picture("duration", to_text(c.duration), "",
                       "these are more than " + to_text(most_frames) +
                           " frames: choose a shorter duration or fewer frames per second");
    return c;
}

/// What the page is asked for: livensReport.record(kind, look, course).
std::string expression_of(const PictureOptions& o, const Motion& motion, const Kind& kind)
{
    const int width = o.width != 0 ? o.width : kind.width, height = o.height != 0 ? o.height : kind.height;
    for (const int side : {width, height}) check_number("size", side, least_side, most_side);
    const Course c = course_of(o, motion, kind);
    JsonWriter look, course;
    look.begin_object().member("width", width).member("height", height).member("side", o.view);
    look.member("scheme", o.is_dark ? "dark" : "light").member("names", o.names);
    look.member("clock", o.clock).end_object();
    course.begin_object().member("from", c.from);
    if (kind.rate > 0)
        course.member("to", c.to).member("speed", (c.to - c.from) / c.duration).member("rate", c.rate);
    course.end_object();
    return "livensReport.record('" + std::string(kind.word) + "', " + look.text() + ", " + course.text() +
           ")";
}

/// A chunk of a PNG: its length, type, content and checksum.
std::string chunk(const std::string& type, const std::string& content)
{
    const auto big = [](std::size_t n) {
        std::string out;
        for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(n >> shift & 0xff);
        return out;
    };
    const std::string body = type + content;
    const auto sum = ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big(content.size()) + body + big(sum);
}

/// So that a later export knows that it may replace it; behind the first chunk, which has 25 bytes, or tag.
std::string signed_picture(std::string picture, std::string_view kind)
{
    constexpr std::size_t head_of_png = 8 + 25;
    using namespace std::string_literals;
    if (kind == "png" && picture.size() > head_of_png)
        picture.insert(head_of_png, chunk("tEXt", "Software\0livens "s + std::string(version)));
    if (kind == "svg") picture.insert(picture.find('>') + 1, "<!-- livens -->");
    return picture;
}

}   // namespace

/// Frames too far apart are told by the middle of the way between two: where bodies turn back it is off the
/// straight line by a quarter of its length.
std::string io_internal::doubt_of_video(const ExportInput& input, std::string_view word)
{
    const Motion& motion = input.run.motion;
    const Course course = course_of(input.picture, motion, *std::ranges::find(kinds, word, &Kind::word));
    const double step = (course.to - course.from) / (course.duration * course.rate),
                 span = course.to - course.from - step;
    const auto centres = [&](double t) { return sample_bodies(input.scenario.model, motion, t); };
    double way = 0, off = 0;
    for (int look = 0; look < frame_looks && span > 0; ++look) {
        // Places that no motion keeps step with.
        const double t = course.from + span * std::fmod(0.5 + look * std::numbers::phi, 1.0);
        const std::vector<BodySample> a = centres(t), between = centres(t + 0.5 * step),
                                      b = centres(t + step);
        for (std::size_t i = 0; i < a.size(); ++i) {
            const Vector3 &from = a[i].center_of_mass, &to = b[i].center_of_mass;
            way += norm(to - from);
            off += norm(between[i].center_of_mass - 0.5 * (from + to));
        }
    }
    if (!(off > bent * way && off > 1e-9 * frame_looks * input.scenario.model.length())) return "";
    return "frames are " + to_text(step, 2) +
           " s of the motion apart, and bodies turn back in between, so that another motion is seen: choose "
           "a "
           "part of it, a longer duration or more frames per second";
}

void io_internal::write_picture(const std::filesystem::path& file, const ExportInput& input,
                                std::string_view word)
{
    const Kind& kind = *std::ranges::find(kinds, word, &Kind::word);
    const std::string expression = expression_of(input.picture, input.run.motion, kind);
    Browser browser;
    browser.open(report_page({input.scenario, input.run, file.stem().string()}));
    const std::string picture = from_base64(browser.evaluate(expression));
    if (picture.empty()) throw IoError("the browser has drawn nothing", "browser");
    replace_file(file, signed_picture(picture, word));
}

}   // namespace livens
