"""What each kind of database needs: how it is connected to, when to try again, how it says that rows came."""
