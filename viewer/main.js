/** Lists the frames of a page. */
const table = document.getElementById("frames");
document.getElementById("title").textContent = document.title;
for (const element of document.querySelectorAll('script[type="text/talus"]')) {
    const row = table.insertRow();
    for (const name of ["frame", "time", "cycle", "largest"])
        row.insertCell().textContent = name + " " + element.dataset[name];
}
