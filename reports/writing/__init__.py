"""What every page is written with: markup, badges, tables of the ledger."""
