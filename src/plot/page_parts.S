/* The parts of the page, and the chart library, as they are in their files; CMakeLists.txt says where. */
#define PART(name, file) \
    .globl name; .hidden name; \
name: \
    .incbin file; \
    .byte 0

    .section .rodata
PART(cm1e_plot_page_html, CM1E_PAGE_HTML)
PART(cm1e_plot_page_css, CM1E_PAGE_CSS)
PART(cm1e_plot_page_js, CM1E_PAGE_JS)
#ifdef CM1E_DYGRAPHS_JS
PART(cm1e_plot_dygraphs_js, CM1E_DYGRAPHS_JS)
PART(cm1e_plot_dygraphs_css, CM1E_DYGRAPHS_CSS)
#else
    .globl cm1e_plot_dygraphs_js, cm1e_plot_dygraphs_css
    .hidden cm1e_plot_dygraphs_js, cm1e_plot_dygraphs_css
cm1e_plot_dygraphs_js:
cm1e_plot_dygraphs_css:
    .byte 0
#endif
    .section .note.GNU-stack, "", %progbits
