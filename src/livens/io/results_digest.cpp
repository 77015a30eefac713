#include <algorithm>
#include <bit>
#include <cstdint>

#include "livens/io/detail/results_digest.h"
#include "livens/io/detail/results_layout.h"

namespace livens {

namespace {

constexpr std::string_view seal_start = "\nlivens ";
constexpr std::size_t seal_size = 24;

/// A number that changes if any bit of the run does; a guard against damage, not against malice.
class Digesting {
public:
    void dimension(const std::string&, std::size_t) {}
    void text(const std::string&, std::string_view value) { add_bytes(value); }
    void number(const std::string&, double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void number(const std::string&, SolveStatus value) { add(static_cast<std::uint64_t>(of_solver(value))); }
    void status(const std::string& name, SolveStatus value) { text(name, to_string(value)); }
    template <class Integer>
    requires std::is_integral_v<Integer>
    void number(const std::string&, Integer value) { add(static_cast<std::uint64_t>(value)); }
    void names(const VariableInfo&, const std::vector<std::string>& values)
    {
        add(values.size());
        for (const std::string& s : values) add_bytes(s);
    }
    void flags(const VariableInfo&, const std::vector<bool>& values)
    {
        add(values.size());
        for (const bool b : values) add(b);
    }
    template <class T>
    void list(const VariableInfo&, const std::vector<T>& values)
    {
        add(values.size());
        if constexpr (is_matrix<T>) {
            for (const double x : numbers(values)) add(std::bit_cast<std::uint64_t>(x));
        } else {
            for (const T x : values) number("", x);
        }
    }
    void field(const VariableInfo& info, const Field& field)
    {
        list(info, field.values);
        if (field.empty()) return;
        add(static_cast<std::uint64_t>(field.n_values));
        add(static_cast<std::uint64_t>(field.degree));
        add(field.continuous);
    }

    std::string text() const
    {
        static constexpr char digits[] = "0123456789abcdef";
        std::string s;
        for (int shift = 60; shift >= 0; shift -= 4) s += digits[(state_ >> shift) & 15];
        return s;
    }

private:
    /// One round of FNV-1a on a word instead of a byte, and its high half folded down.
    void add(std::uint64_t word)
    {
        state_ = (state_ ^ word) * 0x100000001b3u;
        state_ ^= state_ >> 29;
    }
    void add_bytes(std::string_view bytes)
    {
        add(bytes.size());
        for (std::size_t i = 0; i < bytes.size(); i += 8) {
            std::uint64_t word = 0;
            for (std::size_t k = i; k < std::min(i + 8, bytes.size()); ++k)
                word |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[k])) << (8 * (k - i));
            add(word);
        }
    }

    std::uint64_t state_ = 0xcbf29ce484222325u;
};

std::string seal_of(std::string_view image)
{
    Digesting sum;
    sum.text("", image);
    return std::string(seal_start) + sum.text();
}

}   // namespace

std::string digest_of_minor(const Run& run, int minor)
{
    Digesting archive;
    visit_run(archive, run, minor);
    return archive.text();
}

std::string digest(const Run& run)
{
    std::string all;
    for (int minor = 0; minor <= format_minor; ++minor) all += digest_of_minor(run, minor);
    return all;
}

std::string digest_name(int minor)
{
    return minor == 0 ? "livens_digest" : "livens_digest_" + std::to_string(minor);
}

std::string sealed(std::string image)
{
    image += seal_of(image);
    return image;
}

void check_seal(std::string_view bytes)
{
    if (bytes.size() < seal_size) return;
    const std::string_view image = bytes.substr(0, bytes.size() - seal_size),
                           seal = bytes.substr(image.size());
    if (seal.starts_with(seal_start) && seal != seal_of(image))
        throw IoError("the file does not fit the checksum at its end: it is damaged");
}

}   // namespace livens
