"""The field page: the site and its robots on a phone, with the emergency stop."""
