// Nothing: here only to have what every test includes compiled.
