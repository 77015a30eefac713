# SPDX-License-Identifier: BSD-3-Clause
# cmake -DNAME= -DORIGINAL= -DFOLDER= -DMUTATED= -P mutate.cmake: ORIGINAL with FOLDER/old.txt, which must
# stand in it exactly once, replaced by FOLDER/new.txt.

file(READ ${ORIGINAL} source)
file(READ ${FOLDER}/old.txt old)
file(READ ${FOLDER}/new.txt new)
string(FIND "${source}" "${old}" first)
string(FIND "${source}" "${old}" last REVERSE)
if(first EQUAL -1 OR NOT first EQUAL last)
    set(times "more than once")
    if(first EQUAL -1)
        set(times "nowhere")
    endif()
    message(FATAL_ERROR "mutant '${NAME}': its old text stands ${times} in ${ORIGINAL}, but must stand there "
                        "exactly once. Bring tests/mutants/faults.cmake up to the source. The old text:\n"
                        "${old}")
endif()
string(REPLACE "${old}" "${new}" source "${source}")
file(WRITE ${MUTATED} "${source}")
