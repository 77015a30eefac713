// SPDX-License-Identifier: BSD-3-Clause
// A key that its table does not have: of another kind, of another program, or misspelt.
#include "livens/io/scenario/schema/other_keys.h"
#include "livens/io/scenario/schema/section.h"

namespace livens::inline io_internal {

/// Without a known kind the keys of all kinds are known: one that belongs to other kinds is met only where
/// this table has one.
void Section::report_unknown(const Entry& entry, const std::vector<const Key*>& keys)
{
    const Node* title = node_->find("name");
    const bool is_named = title != nullptr && title->kind == Node::Kind::text;
    const KeyAdvice other =
        instead_of_key(*table_, kind_, entry.key, is_named ? title->text() : std::string());
    if (!other.meant.empty()) meant_.push_back(other.meant);
    Words owners;
    for (const Kind& kind : table_->kinds)
        for (const Key& key : kind.keys)
            if (key.name == entry.key) owners.push_back(kind.word);
    if (!owners.empty()) {
        const std::string_view own = table_->kinds[static_cast<std::size_t>(kind_)].word;
        const std::string belongs = "it belongs to " + quoted_alternatives(owners);
        findings_->error(entry.place, "misplaced-key",
                         "'" + entry.key + "' of " + label_ + " does not belong to " +
                             std::string(table_->chooser) + " \"" + std::string(own) + "\"",
                         {other.help.empty() ? belongs : "", other.help});
        return;
    }
    Words names;
    for (const Key* key : keys)
        if (key->type != types::later && index_of(names, key->name) < 0) names.push_back(key->name);
    std::string help = other.help;
    if (help.empty()) {
        const std::string_view misspelt = closest(entry.key, names);
        if (!misspelt.empty()) meant_.push_back(misspelt);
        const bool is_number =
            entry.value.kind == Node::Kind::number || entry.value.kind == Node::Kind::integer;
        if (misspelt.empty() && is_number && is_plain_name(entry.key))
            help = "numbers with names of your own stand in [parameters]; ";
        help += suggest(entry.key, names);
    }
    findings_->error(entry.place, "unknown-key", "unknown key '" + entry.key + "' in " + label_, {"", help});
}

}   // namespace livens::inline io_internal
