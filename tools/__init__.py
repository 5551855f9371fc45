"""What developers run: set-up, demonstrations, pictures, package, translations, mutants, figures."""
