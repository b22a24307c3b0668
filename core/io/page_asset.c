/* page_asset.c - made by scripts/tools/page_asset.py of the files in viewer/: change those. */
/* clang-format off */
#include "io/page_asset.h"

#include <stddef.h>

const char *const tl_page_before[] = {
    "<!doctype html>\n",
    "<html lang=\"en\">\n",
    "<head>\n",
    "<meta charset=\"utf-8\">\n",
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-YwV8KBPTQhnC/UQ+1LcpoUY1EIz4NlpXo17wtjZf4IQ='; style-src 'sha256-JihDTUH+cIPaRBMVzAwYjMv3tmi2mjPewfeqzP/2LY4='; img-src data: blob:; connect-src 'none'; base-uri 'none'; form-action 'none'\">\n",
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
    "<title>",
    NULL};

const char *const tl_page_after[] = {
    "</title>\n",
    "<style>body { font: 16px/1.4 sans-serif; margin: 1em; }\n",
    "table { border-collapse: collapse; }\n",
    "td { border: 1px solid; padding: 0.1em 0.5em; }\n",
    "</style>\n",
    "<script type=\"module\">let table=document.getElementById(\"frames\");document.getElementById(\"title\").textContent=document.title;for(let element of document.querySelectorAll('script[type=\"text/talus\"]')){let row=table.insertRow();for(let name of[\"frame\",\"time\",\"cycle\",\"largest\"])\n",
    "row.insertCell().textContent=name+\" \"+element.dataset[name]}\n",
    "</script>\n",
    "</head>\n",
    "<body>\n",
    "<h1 id=\"title\"></h1>\n",
    "<table id=\"frames\"></table>\n",
    NULL};
