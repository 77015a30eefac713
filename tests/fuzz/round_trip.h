// SPDX-License-Identifier: BSD-3-Clause
// The reader against the writer: a run with whatever in it is read as it was written, and what is read and
// written again is the same file.
#pragma once

#include <algorithm>

#include "fuzz/result.h"
#include "livens/io/results/figures.h"

namespace livens::test {

/// A run of a file, with parts left out and numbers and texts replaced, as the bytes say; still one that
/// check_run() lets pass.
class AnyRun {
public:
    AnyRun(std::string_view program, const Run& run) : rest_(program), run_(run) {}

    Run take()
    {
        while (!rest_.empty()) {
            const unsigned what = next(), n = next();
            change(what, n);
        }
        return std::move(run_);
    }

private:
    unsigned next()
    {
        if (rest_.empty()) return 0;
        const unsigned char byte = static_cast<unsigned char>(rest_.front());
        rest_.remove_prefix(1);
        return byte;
    }
    double number()
    {
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | next();
        return std::bit_cast<double>(bits);
    }
    std::string text(unsigned n)
    {
        std::string bytes;
        for (unsigned i = 0; i < n % 32; ++i) bytes += static_cast<char>(next());
        while (bytes.ends_with('\0')) bytes.pop_back();   // which fill names up
        return bytes;
    }
    void put(std::vector<double>& values)
    {
        if (!values.empty()) values[next() * values.size() / 256] = number();
    }
    void put(std::vector<Matrix34>& values)
    {
        if (!values.empty()) values[next() * values.size() / 256].a[next() % 12] = number();
    }
    void weigh(Field& field)
    {
        if (field.empty()) return;
        field.denominators.assign(field.values.size() / static_cast<std::size_t>(field.n_values), 1);
        field.denominators[next() * field.denominators.size() / 256] = 1 + next();
    }

    void change(unsigned what, unsigned n)
    {
        Motion& m = run_.motion;
        Field* const fields[] = {&m.X, &m.P, &m.multipliers, &m.rigidity};
        std::vector<double>* const lists[] = {&m.X.values,
                                              &m.P.values,
                                              &m.multipliers.values,
                                              &m.rigidity.values,
                                              &m.end_multipliers,
                                              &m.load_angles,
                                              &run_.growth,
                                              &run_.estimate.position,
                                              &run_.estimate.velocity,
                                              &run_.estimate.reaction};
        std::vector<Matrix34>* const ends[] = {&m.momenta, &m.velocities, &m.accelerations};
        switch (what % 14) {
        case 0:
            put(*lists[n % std::size(lists)]);
            break;
        case 1:
            put(*ends[n % std::size(ends)]);
            break;
        case 2:
            weigh(*fields[n % std::size(fields)]);
            break;
        case 3:
            *fields[1 + n % 3] = {};
            break;
        case 4:
            (n % 2 == 0 ? m.end_multipliers : run_.growth).clear();
            break;
        case 5:
            m.accelerations.clear();
            break;
        case 6:
            run_.estimate = {};
            break;
        case 7:
            run_.output.resize(run_.output.size() * n / 256);
            break;
        case 8:
            m.block_ends =
                n % 2 == 0 || m.n_elements() == 0 ? std::vector<int>{} : std::vector{0, m.n_elements()};
            break;
        case 9:
            run_.title = text(n);
            break;
        case 10:
            run_.report.message = text(n);
            break;
        case 11:
            run_.notes.assign(1 + n % 5, text(next()));
            break;
        case 12:
            run_.report.notes.assign(n % 5, text(next()));
            break;
        default: {
            const auto figures = run_figures();
            const Figure& figure = figures[n % figures.size()];
            const bool is_shape = std::string_view(figure.name).starts_with("n_") ||
                                  std::string_view(figure.name) == "gauss_points";
            if (!is_shape) set_figure(run_, figure, number());
        }
        }
    }

    std::string_view rest_;
    Run run_;
};

/// Ends the program unless the run comes back. What is not one (times that do not ascend after all) is
/// refused.
inline void go_round(const Model& model, const Run& run)
{
    const auto written = [&](const Run& it) {
        std::string image;
        write_run_to(
            [&](std::uint64_t offset, std::string_view bytes) {
                image.resize(std::max<std::size_t>(image.size(), offset + bytes.size()));
                bytes.copy(image.data() + offset, bytes.size());
            },
            model, it);
        return image;
    };
    const std::string first = written(run);
    const Run back = read_run_from(source_in(first));
    if (!is_same(back, run) || written(back) != first) std::abort();
}

}   // namespace livens::test
