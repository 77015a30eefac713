# SPDX-License-Identifier: BSD-3-Clause
# The page of `livens report` is compiled in as it lies there; the folder `report` says how it is made.

set(livens_page ${PROJECT_SOURCE_DIR}/src/livens/io/report/page.html)
set_source_files_properties(${PROJECT_SOURCE_DIR}/src/livens/io/report/page.cpp PROPERTIES
    COMPILE_DEFINITIONS LIVENS_REPORT_PAGE="${livens_page}" OBJECT_DEPENDS ${livens_page})
