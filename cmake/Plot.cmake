# The page that cm1e::plot writes: its parts and the chart library dygraphs are in the library, so that a page needs no
# other file. Without dygraphs (Debian package libjs-dygraphs) there are no pages, and cm1e_scheduler_write_html() says so.
find_file(CM1E_DYGRAPHS_JS dygraph.min.js PATHS /usr/share/javascript/dygraphs DOC "dygraphs 2, dygraph.min.js")
find_file(CM1E_DYGRAPHS_CSS dygraph.min.css PATHS /usr/share/javascript/dygraphs DOC "dygraphs 2, dygraph.min.css")
set(parts ${PROJECT_SOURCE_DIR}/src/plot/page_parts.S)
set(files)
foreach(ending html css js)
  string(TOUPPER ${ending} upper)
  list(APPEND files ${PROJECT_SOURCE_DIR}/src/plot/page.${ending})
  set_property(SOURCE ${parts} APPEND PROPERTY COMPILE_DEFINITIONS
               CM1E_PAGE_${upper}="${PROJECT_SOURCE_DIR}/src/plot/page.${ending}")
endforeach()
if(CM1E_DYGRAPHS_JS AND CM1E_DYGRAPHS_CSS)
  list(APPEND files ${CM1E_DYGRAPHS_JS} ${CM1E_DYGRAPHS_CSS})
  set_property(SOURCE ${parts} APPEND PROPERTY COMPILE_DEFINITIONS CM1E_DYGRAPHS_JS="${CM1E_DYGRAPHS_JS}"
               CM1E_DYGRAPHS_CSS="${CM1E_DYGRAPHS_CSS}")
else()
  message(STATUS "dygraphs not found (Debian package libjs-dygraphs): traces are not written as pages")
endif()
set_property(SOURCE ${parts} PROPERTY OBJECT_DEPENDS ${files})
target_sources(cm1e_plot PRIVATE ${parts})
