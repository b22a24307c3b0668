/* no_entry.c - a shared object that is no plugin: it does not export the entry. */
int tl_no_entry(void);

int tl_no_entry(void)
{
    return 0;
}
